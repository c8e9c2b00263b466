/* Runs the firmware's state machine on a script and prints everything it does to its hardware.
 *
 *   r                                      reset
 *   t MS                                   set the time and tick
 *   b HEX                                  receive these bytes
 *   s SETTLED SPIN ANGLE X Y FAILURE STOP  set the sensors
 *   w WORKS                                whether the journal can be written */
#include "robot.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static sensors now_sensed;
static record stored;
static bool has_stored, store_works = true;

void hardware_info(coinmc_info *info)
{
    const coinmc_info this_robot = {{'c', 'o', 'i', 'n', 'm', 'c', '-', '1'}, {0, 1, 0}, 3, 4500,
                                    18000, 400000, 300000};
    *info = this_robot;
}

void hardware_load(record *last)
{
    if (has_stored)
        *last = stored;
}

bool hardware_store(const record *next)
{
    printf("store %" PRIu32 " %" PRIu32 " %u %u\n", next->throw_id, next->experiment, next->boot,
           next->phase);
    if (store_works) {
        stored = *next;
        has_stored = true;
    }
    return store_works;
}

void hardware_start(const motion *next)
{
    now_sensed.settled = false;
    printf("start %u %u %u %u %" PRId32 " %" PRId32 "\n", next->kind, next->axes,
           next->spin_mrev_s, next->angle_cdeg, next->x_um, next->y_um);
}

void hardware_motors_off(void)
{
    printf("off\n");
}

void hardware_light(uint16_t permille)
{
    printf("light %u\n", permille);
}

void hardware_sense(sensors *now)
{
    *now = now_sensed;
}

static void receive(const char *hex, uint32_t now_ms)
{
    char *end;
    for (unsigned long byte = strtoul(hex, &end, 16); end != hex; byte = strtoul(hex, &end, 16)) {
        const uint8_t *reply;
        uint8_t length = robot_receive((uint8_t)byte, now_ms, &reply);
        for (uint8_t i = 0; i < length; i++)
            printf("%s%02x", i == 0 ? "reply " : " ", reply[i]);
        if (length != 0)
            printf("\n");
        hex = end;
    }
}

int main(void)
{
    static char line[4096];
    uint32_t now_ms = 0;
    unsigned works, settled, spin, angle, failure, stopped;
    while (fgets(line, sizeof line, stdin) != NULL) {
        switch (line[0]) {
        case 'r':
            robot_boot(now_ms);
            break;
        case 't':
            now_ms = (uint32_t)strtoul(line + 1, NULL, 10);
            robot_tick(now_ms);
            break;
        case 'b':
            receive(line + 1, now_ms);
            break;
        case 's':
            if (sscanf(line + 1, "%u %u %u %" SCNd32 " %" SCNd32 " %u %u", &settled, &spin, &angle,
                       &now_sensed.x_um, &now_sensed.y_um, &failure, &stopped) != 7)
                return 2;
            now_sensed.settled = settled != 0;
            now_sensed.spin_mrev_s = (uint16_t)spin;
            now_sensed.angle_cdeg = (uint16_t)angle;
            now_sensed.failure = (uint8_t)failure;
            now_sensed.stopped = stopped != 0;
            break;
        case 'w':
            if (sscanf(line + 1, "%u", &works) != 1)
                return 2;
            store_works = works != 0;
            break;
        default:
            return 2;
        }
    }
    return 0;
}
