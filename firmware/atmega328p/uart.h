/* The serial line: 115200 baud, 8 bits, no parity, one stop bit. */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

void uart_begin(void);
/* Reads the next received byte; false if there is none. */
bool uart_read(uint8_t *byte);
/* Sends the bytes; returns within 6 ms, when the last byte is being sent. */
void uart_write(const uint8_t *bytes, uint8_t length);

#endif
