/* Firmware of the coin-tossing robot for the ATmega328P at 16 MHz (Arduino Uno, Nano). */
#include "clock.h"
#include "robot.h"
#include "uart.h"

#include <avr/interrupt.h>
#include <avr/fuse.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

/* Bytes handled between two checks of the limits, 5.6 ms of them: however many arrive. */
#define BYTES_A_TICK 64

/* Written with a programmer, not by a bootloader (docs/reference/robot-protocol.md has the command):
 * crystal of 16 MHz; the bootloader of an Uno is kept, and the EEPROM survives flashing; reset below
 * 4.3 V, because this clock needs 3.8 V and an EEPROM written at less is not to be trusted. */
FUSES = {
    .low = 0xFF,
    .high = (FUSE_SPIEN & FUSE_EESAVE & FUSE_BOOTRST),
    .extended = 0xFC, /* BODLEVEL 100: 4.3 V */
};

/* After a reset by the watchdog it still runs, with its shortest period: stop it first of all. */
void stop_watchdog(void) __attribute__((naked, used, section(".init3")));
void stop_watchdog(void)
{
    MCUSR = 0;
    wdt_disable();
}

int main(void)
{
    hardware_begin();
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
        for (uint8_t i = 0; i < BYTES_A_TICK && uart_read(&byte); i++) {
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
