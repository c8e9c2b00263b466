/* A simulated ATmega328P board whose serial line is a pseudo-terminal: a test tool.
 *
 * It links libsimavr, which is under the GNU GPL 3, and so is the compiled program. It is built for
 * tests on the local machine and never distributed.
 *
 *   board FIRMWARE.elf SPEED
 *
 * Prints "pty NAME", then reads commands from standard input: `system_reset` resets the board (as in
 * QEMU's monitor); `press` and `release` work the emergency stop, `press-storing` presses it as soon as
 * a record is written while the motors have current; `stick` and `unstick` hold every motion, `hang` stops
 * the program, until `recover`; `motors` prints for how many milliseconds the motors have had current now, at
 * most, and after the emergency stop was pressed, and begins that anew; the end of input ends the program.
 * A byte of EEPROM takes 3.4 ms, by the data sheet. SPEED is simulated time over real time. At the
 * end it prints the longest time that the firmware took for a byte, measured by the pins that the
 * firmware sets meanwhile. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#define HERTZ 16000000

/* The control register of the EEPROM, and its bit "a byte is being written". */
#define EECR 0x3F
#define EEPE (1 << 1)
#define EEPROM_BYTE_US 3400

static avr_t *avr;
static int pty;
static avr_irq_t *uart_input;
static bool ready; /* the UART accepts another byte */

/* Cycles for which a pin was high. */
typedef struct {
    avr_cycle_count_t since, longest, total;
    bool high;
} pin;

static pin handling, storing, motors;

/* The emergency stop: to be pressed with the next record; when it was; how long the motors had current then. */
static bool press_when_storing, timing_stop;
static avr_cycle_count_t pressed_at, stop_took;

/* Inputs of port D: the emergency stop (5), closed to ground until it is pressed, the stuck motion (6) and
 * the stuck program (7), pulled up until they are to stick. */
static uint8_t inputs = 1 << 6 | 1 << 7;
static void set_inputs(void);

static void press(void)
{
    inputs |= 1 << 5;
    pressed_at = avr->cycle;
    timing_stop = motors.high;
    stop_took = 0;
    set_inputs();
}
static avr_cycle_count_t stored_before, longest_without_journal;

static void on_pin(struct avr_irq_t *irq, uint32_t value, void *parameter)
{
    (void)irq;
    pin *p = parameter;
    bool high = value != 0;
    if (high == p->high)
        return;
    p->high = high;
    if (high) {
        p->since = avr->cycle;
        if (p == &handling)
            stored_before = storing.total;
        if (p == &storing && press_when_storing && motors.high) {
            press_when_storing = false;
            press();
        }
        return;
    }
    if (p == &motors && timing_stop) {
        timing_stop = false;
        stop_took = avr->cycle - pressed_at;
    }
    avr_cycle_count_t took = avr->cycle - p->since;
    p->total += took;
    if (took > p->longest)
        p->longest = took;
    if (p == &handling && took - (storing.total - stored_before) > longest_without_journal)
        longest_without_journal = took - (storing.total - stored_before);
}

static void on_output(struct avr_irq_t *irq, uint32_t value, void *parameter)
{
    (void)irq;
    (void)parameter;
    uint8_t byte = (uint8_t)value;
    /* nobody at the other end: like an unplugged cable */
    if (write(pty, &byte, 1) < 0 && errno != EAGAIN && errno != EIO)
        perror("pty");
}

static void on_xon(struct avr_irq_t *irq, uint32_t value, void *parameter)
{
    (void)irq;
    (void)value;
    (void)parameter;
    ready = true;
}

static void on_xoff(struct avr_irq_t *irq, uint32_t value, void *parameter)
{
    (void)irq;
    (void)value;
    (void)parameter;
    ready = false;
}

static void set_inputs(void)
{
    avr_ioport_external_t external = {.name = 'D', .mask = 0xE0, .value = inputs};
    avr_ioctl(avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('D'), &external);
    for (int i = 5; i <= 7; i++) {
        avr_irq_t *pin_irq = avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), i);
        /* a value that has not changed would not be passed on, and after a reset it must be */
        avr_raise_irq(pin_irq, !(inputs >> i & 1));
        avr_raise_irq(pin_irq, inputs >> i & 1);
    }
}

static avr_cycle_count_t written(struct avr_t *this_avr, avr_cycle_count_t when, void *parameter)
{
    (void)when;
    (void)parameter;
    this_avr->data[EECR] &= (uint8_t)~EEPE;
    return 0;
}

/* simavr writes a byte at once: here it takes its time. */
static void on_eeprom(struct avr_t *this_avr, avr_io_addr_t address, uint8_t value, void *parameter)
{
    (void)parameter;
    if (!(value & EEPE))
        return;
    this_avr->data[address] |= EEPE;
    avr_cycle_timer_register_usec(this_avr, EEPROM_BYTE_US, written, NULL);
}

static void open_pty(void)
{
    pty = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    struct termios raw;
    if (pty < 0 || grantpt(pty) != 0 || unlockpt(pty) != 0 || tcgetattr(pty, &raw) != 0) {
        perror("pty");
        exit(1);
    }
    cfmakeraw(&raw);
    tcsetattr(pty, TCSANOW, &raw);
    /* kept open here, so that it outlives its users */
    if (open(ptsname(pty), O_RDWR | O_NOCTTY) < 0)
        perror("pty");
    printf("pty %s\n", ptsname(pty));
    fflush(stdout);
}

static void begin(const char *path)
{
    elf_firmware_t firmware;
    memset(&firmware, 0, sizeof firmware);
    if (elf_read_firmware(path, &firmware) != 0)
        exit(1);
    firmware.frequency = HERTZ;
    avr = avr_make_mcu_by_name("atmega328p");
    if (avr == NULL)
        exit(1);
    avr_init(avr);
    avr_load_firmware(avr, &firmware);
    /* simavr must neither print the UART's output nor sleep: both are done here */
    uint32_t flags = 0;
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    uart_input = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
                            on_output, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUT_XON),
                            on_xon, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUT_XOFF),
                            on_xoff, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), 5), on_pin, &handling);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), 4), on_pin, &storing);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 4), on_pin, &motors);
    avr_register_io_write(avr, EECR, on_eeprom, &inputs);
    set_inputs();
}

static void no_sleep(avr_t *this_avr, avr_cycle_count_t cycles)
{
    (void)this_avr;
    (void)cycles;
}

static void reset_board(void)
{
    avr_reset(avr);
    ready = true;
    handling.high = storing.high = false;
    on_pin(NULL, 0, &motors);
    set_inputs();
}

static void print_motors(void)
{
    const double per_ms = HERTZ / 1000.0;
    avr_cycle_count_t now = motors.high ? avr->cycle - motors.since : 0;
    avr_cycle_count_t longest = now > motors.longest ? now : motors.longest;
    avr_cycle_count_t stopping = timing_stop ? avr->cycle - pressed_at : stop_took;
    printf("motors %.0f %.0f %.1f\n", (double)now / per_ms, (double)longest / per_ms,
           (double)stopping / per_ms);
    fflush(stdout);
    motors.longest = 0;
}

static void obey(const char *command)
{
    if (strcmp(command, "system_reset") == 0)
        reset_board();
    else if (strcmp(command, "motors") == 0)
        print_motors();
    else if (strcmp(command, "press") == 0)
        press();
    else if (strcmp(command, "press-storing") == 0)
        press_when_storing = true;
    else if (strcmp(command, "hang") == 0)
        inputs &= (uint8_t)~(1 << 7);
    else if (strcmp(command, "recover") == 0)
        inputs |= 1 << 7;
    else if (strcmp(command, "release") == 0)
        inputs &= (uint8_t)~(1 << 5);
    else if (strcmp(command, "stick") == 0)
        inputs &= (uint8_t)~(1 << 6);
    else if (strcmp(command, "unstick") == 0)
        inputs |= 1 << 6;
    set_inputs();
}

/* Executes the commands that have arrived; false at the end of input. */
static bool execute_command(void)
{
    struct pollfd input = {STDIN_FILENO, POLLIN, 0};
    char line[64] = {0};
    if (poll(&input, 1, 0) <= 0)
        return true;
    ssize_t length = read(STDIN_FILENO, line, sizeof line - 1);
    for (char *word = strtok(line, "\n"); word != NULL; word = strtok(NULL, "\n"))
        obey(word);
    return length > 0;
}

/* Waits until the real time at which the next simulated millisecond is due. */
static void keep_pace(double *due, double speed)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    double seconds = (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
    *due += 0.001 / speed;
    if (*due < seconds - 0.1)
        *due = seconds; /* too slow for this speed: do not try to catch up */
    if (*due > seconds)
        usleep((useconds_t)((*due - seconds) * 1e6));
}

int main(int count, char **arguments)
{
    double speed = count == 3 ? atof(arguments[2]) : 0, due = 0;
    if (speed <= 0) {
        fprintf(stderr, "usage: board FIRMWARE.elf SPEED\n");
        return 2;
    }
    begin(arguments[1]);
    avr->sleep = no_sleep;
    open_pty();
    ready = true;
    while (execute_command()) {
        avr_cycle_count_t until = avr->cycle + HERTZ / 1000;
        while (avr->cycle < until) {
            uint8_t byte;
            if (ready && read(pty, &byte, 1) == 1)
                avr_raise_irq(uart_input, byte);
            avr_cycle_count_t a_byte = avr->cycle + HERTZ / 11520;
            while (avr->cycle < a_byte && avr->cycle < until) {
                int state = avr_run(avr);
                if (state == cpu_Done || state == cpu_Crashed)
                    return 1;
            }
        }
        keep_pace(&due, speed);
    }
    fprintf(stderr, "longest: %llu cycles for a byte, %llu without the journal, %llu for a record\n",
            (unsigned long long)handling.longest, (unsigned long long)longest_without_journal,
            (unsigned long long)storing.longest);
    _exit(0);
}
