#include "clock.h"
#include "hardware.h"

#include <avr/interrupt.h>
#include <util/atomic.h>

static volatile uint32_t elapsed_ms;

ISR(TIMER0_COMPA_vect)
{
    elapsed_ms++;
    hardware_watch();
}

void clock_begin(void)
{
    TCCR0A = _BV(WGM01);             /* clear on compare match */
    TCCR0B = _BV(CS01) | _BV(CS00);  /* 16 MHz / 64 / 250 = 1 kHz */
    OCR0A = 249;
    TIMSK0 = _BV(OCIE0A);
}

uint32_t clock_ms(void)
{
    uint32_t now;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        now = elapsed_ms;
    }
    return now;
}
