/* See cycle.h. Kept in step with crates/coinmc-link/src/device/cycle.rs: the rules are explained
 * there. */
#include "cycle.h"

#define AT_COIN_LIMIT_MS 60000
#define SILENCE_LIMIT_MS 5000
#define BOOT_LIMIT_MS 10000
#define HOME_LIMIT_MS 10000
#define MOVE_LIMIT_MS 5000

cycle_of_throw cycle;

static bool in_cycle(uint8_t state)
{
    return state >= COINMC_AIMING && state <= COINMC_RETURNING;
}

static void switch_off(void)
{
    hardware_motors_off();
    cycle.moving = false;
}

static void fail(uint16_t code)
{
    switch_off();
    cycle.state = COINMC_FAULT;
    cycle.fault = code;
}

static bool journal(uint8_t phase)
{
    record next = {cycle.throw_id, cycle.experiment, cycle.boot, phase};
    return hardware_store(&next);
}

static bool journal_or_fail(uint8_t phase)
{
    bool stored = journal(phase);
    if (!stored)
        fail(COINMC_FAULT_JOURNAL);
    return stored;
}

/* Enters a state: writes the journal first, then starts the motion. */
static void enter(uint8_t state, const motion *next, uint32_t now_ms)
{
    cycle.state = state;
    cycle.since_ms = now_ms;
    if (journal_or_fail(state) && next != NULL)
        hardware_start(next);
}

static void enter_moving(uint8_t state, uint8_t kind, uint32_t now_ms)
{
    motion next = {0};
    next.kind = kind;
    enter(state, &next, now_ms);
}

/* The last throw is this one, and nothing else is known of it. */
static void forget_throw(const coinmc_request *request)
{
    cycle.throw_id = request->throw_id;
    cycle.experiment = request->experiment;
    cycle.asked_spin = cycle.asked_angle = 0;
    cycle.released = cycle.measured = false;
}

void cycle_boot(uint32_t now_ms)
{
    memset(&cycle, 0, sizeof cycle);
    hardware_motors_off();
    record last = {0, 0, 0, COINMC_IDLE};
    hardware_load(&last);
    cycle.since_ms = cycle.heard_ms = now_ms;
    cycle.state = COINMC_BOOT;
    cycle.throw_id = last.throw_id;
    cycle.experiment = last.experiment;
    cycle.boot = (uint16_t)(last.boot + 1);
    cycle.silent = true;
    /* an emergency stop leaves no record of the phase */
    cycle.released = last.phase == COINMC_FAULT ||
                     (in_cycle(last.phase) && last.phase != COINMC_AIMING);
    /* the phase stays in the journal, so that a second reset finds it again */
    bool stored = journal(last.phase);
    if (last.phase == COINMC_FAULT)
        fail(COINMC_FAULT_EMERGENCY);
    else if (in_cycle(last.phase))
        fail((uint16_t)(COINMC_FAULT_RESET + last.phase));
    else if (!stored)
        fail(COINMC_FAULT_JOURNAL);
}

/* ---- time ---- */

static uint32_t limit_ms(uint8_t state)
{
    switch (state) {
    case COINMC_BOOT:
        return BOOT_LIMIT_MS;
    case COINMC_AIMING:
    case COINMC_FLYING:
        return 3000;
    case COINMC_DRIVING:
        return 4000;
    case COINMC_AT_COIN:
        return AT_COIN_LIMIT_MS;
    case COINMC_RETURNING:
        return 5000;
    default:
        return 0;
    }
}

static void check_silence(uint32_t now_ms)
{
    if (!cycle.silent && now_ms - cycle.heard_ms >= SILENCE_LIMIT_MS) {
        cycle.silent = true;
        /* at the coin nothing moves: the host may still come back and photograph it */
        if (in_cycle(cycle.state) && cycle.state != COINMC_AT_COIN)
            fail(COINMC_FAULT_SILENCE);
    }
    if (cycle.silent || cycle.state == COINMC_FAULT)
        switch_off();
}

/* Latches the emergency stop: the motors first, then the journal, which outlasts a reset. */
static void stop_in_emergency(void)
{
    bool latched = cycle.state == COINMC_FAULT && cycle.fault == COINMC_FAULT_EMERGENCY;
    fail(COINMC_FAULT_EMERGENCY);
    if (!latched)
        journal(COINMC_FAULT);
}

/* Whether what the robot does now has taken longer than its limit. */
static bool is_late(uint32_t now_ms)
{
    if (cycle.state == COINMC_IDLE)
        return cycle.moving && now_ms - cycle.moving_since_ms >= cycle.moving_limit_ms;
    uint32_t limit = limit_ms(cycle.state);
    return limit != 0 && now_ms - cycle.since_ms >= limit;
}

/* Enters the next phase if the present one ends without a request; whether it did. */
static bool advance(const sensors *now, uint32_t now_ms)
{
    switch (cycle.state) {
    case COINMC_BOOT:
        cycle.state = COINMC_IDLE;
        return true;
    case COINMC_AIMING:
        enter_moving(COINMC_FLYING, MOTION_RELEASE, now_ms);
        if (cycle.state == COINMC_FLYING) {
            cycle.released = cycle.measured = true;
            cycle.release_ms = now_ms;
            cycle.release_spin = now->spin_mrev_s;
            cycle.release_angle = now->angle_cdeg;
        }
        return true;
    case COINMC_FLYING:
        enter_moving(COINMC_DRIVING, MOTION_DRIVE_TO_COIN, now_ms);
        return true;
    case COINMC_DRIVING:
        enter(COINMC_AT_COIN, NULL, now_ms);
        return true;
    case COINMC_RETURNING:
        enter(COINMC_IDLE, NULL, now_ms);
        return true;
    case COINMC_IDLE: /* what does not move has no current */
        switch_off();
        return true;
    default:
        return false;
    }
}

void cycle_tick(uint32_t now_ms)
{
    check_silence(now_ms);
    sensors now;
    hardware_sense(&now);
    if (now.stopped) {
        stop_in_emergency();
        return;
    }
    if (cycle.state == COINMC_FAULT)
        return; /* only ClearFault leads out */
    if (now.failure != 0)
        fail((uint16_t)(COINMC_FAULT_HARDWARE + now.failure));
    else if (now.settled && advance(&now, now_ms))
        return; /* at most one phase per tick */
    else if (is_late(now_ms))
        fail((uint16_t)(COINMC_FAULT_LIMIT + cycle.state));
}

void cycle_heard(uint32_t now_ms)
{
    cycle.heard_ms = now_ms;
    cycle.silent = false;
}

/* ---- requests ---- */

static uint8_t require_idle(void)
{
    if (cycle.state == COINMC_IDLE)
        return CYCLE_DONE;
    return cycle.state == COINMC_BOOT ? COINMC_NAK_BUSY : COINMC_NAK_WRONG_STATE;
}

uint8_t cycle_move(const coinmc_request *request, uint8_t kind, uint32_t now_ms)
{
    uint8_t nak = require_idle();
    if (nak != CYCLE_DONE)
        return nak;
    if (cycle.moving) /* a second motion would begin the limit anew */
        return COINMC_NAK_BUSY;
    cycle.moving = true;
    cycle.moving_since_ms = now_ms;
    cycle.moving_limit_ms = kind == MOTION_HOME ? HOME_LIMIT_MS : MOVE_LIMIT_MS;
    motion next = {kind, request->axes, 0, 0, request->x_um, request->y_um};
    hardware_start(&next);
    return CYCLE_DONE;
}

uint8_t cycle_throw(const coinmc_request *request, uint32_t now_ms)
{
    if (request->throw_id == cycle.throw_id && request->experiment == cycle.experiment)
        return CYCLE_DONE;
    if (request->throw_id <= cycle.throw_id)
        return COINMC_NAK_WRONG_ID;
    uint8_t nak = require_idle();
    if (nak != CYCLE_DONE)
        return nak;
    if (cycle.moving)
        return COINMC_NAK_BUSY;
    sensors now;
    hardware_sense(&now);
    if (!now.settled)
        return COINMC_NAK_BUSY;
    forget_throw(request);
    cycle.asked_spin = request->spin_mrev_s;
    cycle.asked_angle = request->angle_cdeg;
    motion aim = {MOTION_AIM, 0, request->spin_mrev_s, request->angle_cdeg, 0, 0};
    enter(COINMC_AIMING, &aim, now_ms);
    return CYCLE_DONE;
}

uint8_t cycle_collect(const coinmc_request *request, uint32_t now_ms)
{
    if (request->throw_id != cycle.throw_id)
        return COINMC_NAK_WRONG_ID;
    switch (cycle.state) {
    case COINMC_AT_COIN:
        enter_moving(COINMC_RETURNING, MOTION_RETURN, now_ms);
        return CYCLE_DONE;
    case COINMC_RETURNING: /* again: the first reply was lost with its session */
    case COINMC_IDLE:
        return CYCLE_DONE;
    default:
        return COINMC_NAK_WRONG_STATE;
    }
}

uint8_t cycle_clear_fault(const coinmc_request *request)
{
    if (cycle.state != COINMC_FAULT || cycle.fault != request->code)
        return COINMC_NAK_WRONG_STATE;
    sensors now;
    hardware_sense(&now);
    if (now.stopped)
        return COINMC_NAK_BUSY;
    switch_off();
    if (journal(COINMC_IDLE)) {
        cycle.state = COINMC_IDLE;
        cycle.fault = 0;
    } else {
        cycle.fault = COINMC_FAULT_JOURNAL;
    }
    return CYCLE_DONE;
}

uint8_t cycle_set_counter(const coinmc_request *request)
{
    uint8_t nak = require_idle();
    if (nak == CYCLE_DONE) {
        forget_throw(request);
        journal_or_fail(COINMC_IDLE);
    }
    return nak;
}

uint8_t cycle_stop(void)
{
    if (in_cycle(cycle.state))
        fail(COINMC_FAULT_STOPPED);
    else
        switch_off();
    return CYCLE_DONE;
}
