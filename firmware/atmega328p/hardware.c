/* REPLACE THIS FILE for a real robot. Instead of driving motors and sensors, this stand-in only takes
 * time, and less than a robot would. The contract is in hardware.h; the journal can be used as it is.
 *
 * Two pins are real: PD4 enables all motor drivers (high; a pull-down of 10 kOhm keeps them off while
 * the chip is in reset or being flashed), and PD5 reads the emergency stop, a normally closed contact
 * to ground: a pressed button and a cut wire read the same. The contact must also cut the motors'
 * supply by itself: the pin only tells the firmware. */
#include "clock.h"
#include "journal.h"

#include <avr/io.h>

/* Duration of each motion, ms; by motion_kind. */
static const uint16_t duration_ms[] = {80, 120, 130, 150, 200, 50};

static motion last;
static uint16_t began_ms;
static bool moving;
static int32_t x_um, y_um;
static volatile bool pressed; /* since hardware_sense looked last */

void hardware_begin(void)
{
    PORTD = (uint8_t)((PORTD & ~_BV(PORTD4)) | _BV(PORTD5) | _BV(PORTD6) | _BV(PORTD7)); /* motors off; pull-ups */
    DDRD |= _BV(DDD4);
}

void hardware_info(coinmc_info *info)
{
    static const coinmc_info this_robot = {
        {'a', 't', 'm', 'e', 'g', 'a', '-', '1'}, {0, 2, 0}, COINMC_HAS_LIGHT | COINMC_HAS_CARRIAGE,
        5000, 18000, 400000, 300000};
    *info = this_robot;
}

void hardware_load(record *newest)
{
    journal_load(newest);
}

bool hardware_store(const record *next)
{
    PORTB |= _BV(PORTB4); /* for a logic analyser: the journal is being written */
    bool stored = journal_store(next);
    PORTB &= (uint8_t)~_BV(PORTB4);
    return stored;
}

void hardware_start(const motion *next)
{
    last = *next;
    began_ms = (uint16_t)clock_ms();
    moving = true;
    /* stays on until switched off: motors hold their place */
    if (!pressed)
        PORTD |= _BV(PORTD4);
}

void hardware_watch(void)
{
    if (PIND & _BV(PIND5)) {
        PORTD &= (uint8_t)~_BV(PORTD4);
        pressed = true;
    }
}

void hardware_motors_off(void)
{
    PORTD &= (uint8_t)~_BV(PORTD4);
    moving = false;
}

void hardware_light(uint16_t permille)
{
    /* timer 2, output OC2A (pin PB3) */
    OCR2A = (uint8_t)((uint32_t)permille * 255 / 1000);
}

static void arrive(void)
{
    moving = false;
    if (last.kind == MOTION_MOVE_CARRIAGE) {
        x_um = last.x_um;
        y_um = last.y_um;
    } else if (last.kind == MOTION_DRIVE_TO_COIN) {
        /* the coin has come to rest somewhere */
        x_um = (int32_t)(clock_ms() % 300) * 1000;
        y_um = (int32_t)(clock_ms() % 200) * 1000;
    } else if (last.kind == MOTION_RETURN || last.kind == MOTION_HOME) {
        x_um = y_um = 0;
    }
}

void hardware_sense(sensors *now)
{
    /* PD7 pulled low: the program hangs; PD6: the motion is stuck. Both for tests */
    while ((PIND & _BV(PIND7)) == 0)
        ;
    bool stuck = (PIND & _BV(PIND6)) == 0;
    if (moving && !stuck && (uint16_t)(clock_ms() - began_ms) >= duration_ms[last.kind])
        arrive();
    now->settled = !moving;
    bool aimed = last.kind == MOTION_AIM;
    now->spin_mrev_s = aimed ? last.spin_mrev_s : 0;
    now->angle_cdeg = aimed ? last.angle_cdeg : 0;
    now->x_um = x_um;
    now->y_um = y_um;
    now->failure = 0;
    now->stopped = pressed;
    pressed = false;
    if (PIND & _BV(PIND5))
        now->stopped = true;
}
