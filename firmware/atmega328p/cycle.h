/* The cycle of a throw: its phases, their time limits, the journal, and silence of the host. */
#ifndef CYCLE_H
#define CYCLE_H

#include "hardware.h"

typedef struct {
    uint8_t state;
    uint32_t throw_id, experiment;
    uint16_t asked_spin, asked_angle; /* 0 after a start */
    uint16_t boot, fault;
    uint32_t since_ms, heard_ms;
    bool silent;   /* the host has been silent for too long, or has never sent a valid frame */
    bool moving;   /* a motion on request, since and with a limit: */
    uint32_t moving_since_ms, moving_limit_ms;
    bool released; /* the coin may have been released */
    bool measured; /* it was released since the start, with these measurements: */
    uint32_t release_ms;
    uint16_t release_spin, release_angle;
} cycle_of_throw;

extern cycle_of_throw cycle;

#define CYCLE_DONE 0xFF /* no Nak */

void cycle_boot(uint32_t now_ms);
void cycle_tick(uint32_t now_ms);
/* Notes that a valid frame arrived. */
void cycle_heard(uint32_t now_ms);

/* Requests; they return CYCLE_DONE or a coinmc_nak. */
uint8_t cycle_move(const coinmc_request *request, uint8_t kind, uint32_t now_ms);
uint8_t cycle_throw(const coinmc_request *request, uint32_t now_ms);
uint8_t cycle_collect(const coinmc_request *request, uint32_t now_ms);
uint8_t cycle_clear_fault(const coinmc_request *request);
uint8_t cycle_set_counter(const coinmc_request *request);
uint8_t cycle_stop(void);

#endif
