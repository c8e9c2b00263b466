/* A ring of records in EEPROM, which spreads the wear over all cells: 60 slots of 100,000 writes
 * each last for a million throws of six records, eight months at 4000 per day, and cells that fail are
 * skipped. If a loss of power interrupts a record, its CRC is wrong, and the previous record is the
 * newest. The serial number never comes back: a slot that can no longer be written keeps its old
 * record, which must not look new again after some rounds of the ring. */
#include "journal.h"

#include <avr/eeprom.h>
#include <util/crc16.h>

typedef struct {
    uint32_t serial; /* counts the records; the cells wear out before it ends */
    uint32_t throw_id, experiment;
    uint16_t boot;
    uint8_t phase;
    uint16_t crc;
} slot;

#define SLOTS (1024 / sizeof(slot))
#define TRIES 2 /* 34 ms each as a rule, 58 ms at most */

static uint8_t newest;
static uint32_t serial;

static uint16_t crc_of(const slot *s)
{
    const uint8_t *bytes = (const uint8_t *)s;
    uint16_t crc = 0xFFFF;
    for (uint8_t i = 0; i < offsetof(slot, crc); i++)
        crc = _crc_ccitt_update(crc, bytes[i]);
    return crc;
}

static void *address(uint8_t index)
{
    return (void *)(uintptr_t)(index * sizeof(slot));
}

static bool read_slot(uint8_t index, slot *s)
{
    eeprom_read_block(s, address(index), sizeof *s);
    return s->crc == crc_of(s);
}

void journal_load(record *last)
{
    bool found = false;
    newest = SLOTS - 1;
    serial = 0;
    for (uint8_t i = 0; i < SLOTS; i++) {
        slot s;
        if (!read_slot(i, &s) || (found && s.serial <= serial))
            continue;
        found = true;
        newest = i;
        serial = s.serial;
        last->throw_id = s.throw_id;
        last->experiment = s.experiment;
        last->boot = s.boot;
        last->phase = s.phase;
    }
}

bool journal_store(const record *next)
{
    slot s = {serial + 1, next->throw_id, next->experiment, next->boot, next->phase, 0}, again;
    s.crc = crc_of(&s);
    for (uint8_t i = 0; i < TRIES; i++) {
        newest = (uint8_t)((newest + 1) % SLOTS);
        eeprom_update_block(&s, address(newest), sizeof s);
        eeprom_busy_wait();
        if (read_slot(newest, &again) && again.serial == s.serial) {
            serial = s.serial;
            return true;
        }
    }
    return false;
}
