#include "uart.h"

#include <avr/interrupt.h>
#include <avr/io.h>

/* Room for two frames, which may arrive while the journal is written. Bytes that do not fit are
 * lost, and the host repeats its request. */
#define RING 128

static volatile uint8_t ring[RING], head, tail;

ISR(USART_RX_vect)
{
    uint8_t byte = UDR0, next = (uint8_t)((head + 1) % RING);
    if (next != tail) {
        ring[head] = byte;
        head = next;
    }
}

void uart_begin(void)
{
    /* 16 MHz / 8 / (16 + 1) = 117647: 2.1 % fast, the closest to 115200, and good enough */
    UBRR0 = 16;
    UCSR0A = _BV(U2X0);
    UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
}

bool uart_read(uint8_t *byte)
{
    if (tail == head)
        return false;
    *byte = ring[tail];
    tail = (uint8_t)((tail + 1) % RING);
    return true;
}

void uart_write(const uint8_t *bytes, uint8_t length)
{
    for (uint8_t i = 0; i < length; i++) {
        while (!(UCSR0A & _BV(UDRE0)))
            ;
        UDR0 = bytes[i];
    }
}
