/* As in avr-libc, by its documentation. */
#ifndef CRC16_H
#define CRC16_H

#include <stdint.h>

static inline uint16_t _crc_ccitt_update(uint16_t crc, uint8_t data)
{
    data = (uint8_t)(data ^ (crc & 0xFF));
    data = (uint8_t)(data ^ (data << 4));
    return (uint16_t)(((uint16_t)data << 8 | crc >> 8) ^ (uint8_t)(data >> 4) ^ (uint16_t)(data << 3));
}

#endif
