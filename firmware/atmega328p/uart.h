/* The serial line: 115200 baud, 8 bits, no parity, one stop bit. */
#ifndef UART_H
#define UART_H

#include <stdbool.h>
#include <stdint.h>

void uart_begin(void);
/* The next byte received; false: none waits. */
bool uart_read(uint8_t *byte);
/* Sends; returns when the last byte is on its way, below 6 ms. */
void uart_write(const uint8_t *bytes, uint8_t length);

#endif
