/* The firmware's journal on an EEPROM that takes 3.4 ms a byte, with a reset at every one of them: the
 * record before or the one being written is found, never another one. Also with cells that are worn out.
 * Prints how many resets there were, and how long a record took at most, in microseconds. */
#include "journal.h"

#include <avr/eeprom.h>
#include <inttypes.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CELLS 1024
#define SLOT 17
#define BYTE_US 3400

static uint8_t cells[CELLS];
static bool worn[CELLS];
static jmp_buf off;
static int left;       /* bytes until the reset; -1: none comes */
static int unfinished; /* what the byte in work is left as: 0 as it was, 1 erased, 2 anything */
static bool downwards; /* the library's order is its own affair */
static uint32_t taken_us, longest_us, resets;

static uint32_t number(void)
{
    static uint32_t word = 1;
    word ^= word << 13;
    word ^= word >> 17;
    word ^= word << 5;
    return word;
}

void eeprom_read_block(void *to, const void *from, size_t length)
{
    memcpy(to, cells + (uintptr_t)from, length);
}

void eeprom_busy_wait(void)
{
}

static void update(size_t at, uint8_t value)
{
    if (cells[at] == value)
        return;
    if (left == 0) {
        if (unfinished == 1)
            cells[at] = 0xFF;
        else if (unfinished == 2)
            cells[at] = (uint8_t)number();
        resets++;
        longjmp(off, 1);
    }
    left -= left > 0;
    taken_us += BYTE_US;
    if (!worn[at])
        cells[at] = value;
}

void eeprom_update_block(const void *from, void *to, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        size_t byte = downwards ? length - 1 - i : i;
        update((uintptr_t)to + byte, ((const uint8_t *)from)[byte]);
    }
}

static bool same(const record *a, const record *b)
{
    return a->throw_id == b->throw_id && a->experiment == b->experiment && a->boot == b->boot &&
           a->phase == b->phase;
}

static record numbered(uint32_t n)
{
    record r = {n / 6, 0x5A5A0000u ^ n, (uint16_t)(n / 40), (uint8_t)(n % 8)};
    return r;
}

static record newest(void)
{
    record found = {0, 0, 0, 0};
    journal_load(&found);
    return found;
}

static void check(bool right, const char *what, uint32_t n)
{
    if (!right) {
        printf("record %" PRIu32 ": %s\n", n, what);
        exit(1);
    }
}

/* Stores a record; false if a reset comes or it cannot be stored. */
static bool try_to_store(const record *next)
{
    return setjmp(off) == 0 && journal_store(next);
}

/* Three rounds of the ring; before every record the power fails at every byte of it. */
static void cut_every_record(void)
{
    static uint8_t before[CELLS];
    memset(cells, 0xFF, sizeof cells);
    record safe = {0, 0, 0, 0};
    for (uint32_t n = 1; n < 180; n++) {
        record next = numbered(n);
        memcpy(before, cells, sizeof cells);
        for (int bytes = 0; bytes < SLOT; bytes++) {
            memcpy(cells, before, sizeof cells);
            record found = newest();
            check(same(&found, &safe), "the record before is lost", n);
            left = bytes;
            bool stored = try_to_store(&next);
            found = newest();
            check(same(&found, &next) || (!stored && same(&found, &safe)), "another one is found", n);
            /* and what was interrupted is made up for, on what it has left */
            record later = same(&found, &next) ? numbered(n + 1000) : next;
            left = -1;
            check(journal_store(&later), "the next one is not stored", n);
            found = newest();
            check(same(&found, &later), "the next one is not found", n);
        }
        memcpy(cells, before, sizeof cells);
        newest();
        left = -1;
        taken_us = 0;
        check(journal_store(&next), "it is not stored", n);
        if (taken_us > longest_us)
            longest_us = taken_us;
        safe = next;
    }
}

/* Records in cells that no longer change stay old, however often the ring is passed. */
static void wear_out(void)
{
    memset(cells, 0xFF, sizeof cells);
    left = -1;
    newest();
    for (uint32_t n = 1; n < 400; n++) {
        record next = numbered(n), found;
        if (n == 100 || n == 200) {
            worn[number() % (60 * SLOT)] = true;
            newest();
        }
        taken_us = 0;
        check(journal_store(&next), "it is not stored", n);
        if (taken_us > longest_us)
            longest_us = taken_us;
        found = newest();
        check(same(&found, &next), "it is not found", n);
    }
    memset(worn, 0, sizeof worn);
}

int main(void)
{
    for (int order = 0; order < 2; order++) {
        downwards = order == 1;
        for (unfinished = 0; unfinished < 3; unfinished++)
            cut_every_record();
        for (int i = 0; i < 20; i++)
            wear_out();
    }
    printf("%" PRIu32 " %" PRIu32 "\n", resets, longest_us);
    return 0;
}
