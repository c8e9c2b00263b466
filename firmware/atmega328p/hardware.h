/* What the robot is made of, as robot.c sees it: the same contract as the trait `Hardware` of the
 * crate coinmc-link. hardware.c is the place for pins and motors. Nothing here may wait, except that
 * hardware_store returns only when the record is safe. */
#ifndef HARDWARE_H
#define HARDWARE_H

#include "coinmc_link.h"

typedef enum {
    MOTION_AIM,           /* spin and angle; settled when the coin may be released */
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
    bool settled; /* the motion begun last has reached its goal; at the start: ready */
    uint16_t spin_mrev_s, angle_cdeg;
    int32_t x_um, y_um;
    uint8_t failure; /* 0: nothing is broken; else fault 300 + it */
} sensors;

/* What outlives a reset. */
typedef struct {
    uint32_t throw_id;
    uint16_t boot;
    uint8_t phase;
} record;

void hardware_info(coinmc_info *info);
/* The newest record stored whole; leaves `last` alone if there was never one. */
void hardware_load(record *last);
/* Whether it is safe now. One cut short by a loss of power leaves the one before it readable. */
bool hardware_store(const record *next);
void hardware_start(const motion *next);
void hardware_motors_off(void);
void hardware_light(uint16_t permille);
void hardware_sense(sensors *now);

#endif
