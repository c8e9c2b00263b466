/* The robot's side of the link: answers requests, runs the cycle of a throw, keeps its journal.
 * The same state machine as `Device` of the crate coinmc-link, and tested against it byte for byte.
 *
 * Times are in ms from any origin and may wrap. */
#ifndef ROBOT_H
#define ROBOT_H

#include "hardware.h"

/* After power-on or reset. */
void robot_boot(uint32_t now_ms);

/* Takes one received byte. If it completed a request, points to the reply and returns its length,
 * otherwise 0. Valid until the next call. */
uint8_t robot_receive(uint8_t byte, uint32_t now_ms, const uint8_t **reply);

/* Call it about every 10 ms or more often: only then do phases advance and limits apply. */
void robot_tick(uint32_t now_ms);

#endif
