/* The robot's side of the link: answers requests, runs the cycle of a throw, keeps its journal.
 * The same state machine as `Device` of the crate coinmc-link, and tested against it byte for byte.
 *
 * Times are in ms from any origin and may wrap. */
#ifndef ROBOT_H
#define ROBOT_H

#include "hardware.h"

/* After power-on or reset. */
void robot_boot(uint32_t now_ms);

/* One byte from the line; what to send, of this length (0: nothing), when it ended a request. Valid
 * until the next call. */
uint8_t robot_receive(uint8_t byte, uint32_t now_ms, const uint8_t **reply);

/* At least every 10 ms or so: phases advance and limits hold only then. */
void robot_tick(uint32_t now_ms);

#endif
