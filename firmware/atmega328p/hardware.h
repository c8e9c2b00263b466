/* The interface between robot.c and the hardware: the same contract as the trait `Hardware` of the
 * crate coinmc-link. hardware.c is the place for pins and motors. No function may block, except that
 * hardware_store returns only when the record is safe. */
#ifndef HARDWARE_H
#define HARDWARE_H

#include "coinmc_link.h"

typedef enum {
    MOTION_AIM,           /* spin and angle; settled when the coin can be released */
    MOTION_RELEASE,       /* settled when the coin lies still */
    MOTION_DRIVE_TO_COIN,
    MOTION_RETURN,
    MOTION_HOME,          /* axes */
    MOTION_MOVE_CARRIAGE, /* x_um and y_um from home */
} motion_kind;

typedef struct {
    uint8_t kind, axes;
    uint16_t spin_mrev_s, angle_cdeg;
    int32_t x_um, y_um;
} motion;

typedef struct {
    bool settled; /* the last motion has reached its goal; before the first: ready */
    uint16_t spin_mrev_s, angle_cdeg;
    int32_t x_um, y_um;
    uint8_t failure; /* 0: none; otherwise the fault code is 300 plus this */
    bool stopped;    /* the emergency stop is pressed */
} sensors;

/* A journal record, which survives a reset. */
typedef struct {
    uint32_t throw_id, experiment;
    uint16_t boot;
    uint8_t phase; /* idle, the phase of the unfinished throw, or fault after an emergency stop */
} record;

/* Sets the pins; motors off. Called first of all. */
void hardware_begin(void);
void hardware_info(coinmc_info *info);
/* Loads the newest completely stored record; leaves `last` unchanged if there is none. */
void hardware_load(record *last);
/* Stores a record; whether it is safe now. If a loss of power interrupts it, the previous record stays
 * readable. */
bool hardware_store(const record *next);
void hardware_start(const motion *next);
/* Switches off the current of all motors and ends the motion. */
void hardware_motors_off(void);
void hardware_light(uint16_t permille);
void hardware_sense(sensors *now);
/* Called every millisecond, in an interrupt: takes the motors' current at an emergency stop, whatever the
 * firmware does meanwhile (a record of the journal takes 60 ms). hardware_sense then tells of it. */
void hardware_watch(void);

#endif
