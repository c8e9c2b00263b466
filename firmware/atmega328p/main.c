/* Firmware of the coin-tossing robot for the ATmega328P at 16 MHz (Arduino Uno, Nano). */
#include "clock.h"
#include "robot.h"
#include "uart.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

/* After a reset by the watchdog it still runs, with its shortest period: stop it first of all. */
void stop_watchdog(void) __attribute__((naked, used, section(".init3")));
void stop_watchdog(void)
{
    MCUSR = 0;
    wdt_disable();
}

int main(void)
{
    DDRB = _BV(DDB3) | _BV(DDB4) | _BV(DDB5);
    TCCR2A = _BV(COM2A1) | _BV(WGM21) | _BV(WGM20); /* the lamp: PWM at 1 kHz */
    TCCR2B = _BV(CS22);
    clock_begin();
    uart_begin();
    wdt_enable(WDTO_1S);
    sei();
    robot_boot(clock_ms());
    for (;;) {
        uint8_t byte;
        while (uart_read(&byte)) {
            const uint8_t *reply;
            PORTB |= _BV(PORTB5); /* the board's lamp: a byte is being handled */
            uint8_t length = robot_receive(byte, clock_ms(), &reply);
            PORTB &= (uint8_t)~_BV(PORTB5);
            uart_write(reply, length);
        }
        robot_tick(clock_ms());
        wdt_reset();
        sleep_mode(); /* until the next byte or millisecond */
    }
}
