/* The EEPROM of eeprom.c in place of the chip's. */
#ifndef EEPROM_H
#define EEPROM_H

#include <stddef.h>
#include <stdint.h>

void eeprom_read_block(void *to, const void *from, size_t length);
void eeprom_update_block(const void *from, void *to, size_t length);
void eeprom_busy_wait(void);

#endif
