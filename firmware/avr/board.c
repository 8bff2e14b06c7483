/* An emulated Arduino Uno or Mega with a simulated spring on it: the board's serial line is standard input
 * and output, or a pseudo-terminal whose name goes to standard error. The chip's clock is the
 * clock: after each sample the board waits until the answer is there, so that a slow host is no
 * delay, unless --cut has cut the line.
 *
 *   board ELF [--pty] [--mega] [--wire] [--seconds S] [--trace FILE] [--stack] [--strength X]
 *             [--stroke X] [--cut S] [--hang S] [--noise P] [--loose S] [--jam S] [--restart S]
 *
 * --jam: the slider stands still from then on, and its ADC goes on with its noise.
 * --wire, --strength, --stroke: another actuator (plant.h). The trace has a row for each millisecond,
 * or for ten with --strength: time, wanted and actual position, drive. --stack prints the most bytes
 * that the stack ever took. */
#define _GNU_SOURCE
#include "plant.h"
#include <fcntl.h>
#include <poll.h>
#include <simavr/avr_adc.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_time.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#define PER_MS 11 /* bytes in a millisecond at 115200 baud */
/* How long to wait for an answer, ms. Noise may have eaten the question. */
#define PATIENCE (noise > 0 ? 200 : 2000)
#define AFTER 4 /* s that the board goes on when the host is gone */
#define HANG 0xCFFF /* rjmp to itself */

static const char *chip = "atmega328p";
static int in = 0, out, has_host, waits, at_start = 1, is_sample;
static int is_mega;
static double strength, stroke = 1; /* of another actuator; 0 for the spring */
static double now, seconds = 1e9, cut = 1e9, hang = 1e9, loose = 1e9, jam = 1e9, restart = 1e9, noise;
static unsigned char queue[4096];
static size_t from, to;
static plant spring;
static avr_irq_t *serial, *adc;
static FILE *trace;

static double chance(void) { return random() / (RAND_MAX + 1.0); }

/* A bit of some bytes turns on a noisy line. */
static unsigned char noisy(unsigned char byte) {
    return chance() < noise ? byte ^ (1u << random() % 7) : byte;
}

static void said(avr_irq_t *irq, uint32_t value, void *param) {
    unsigned char byte = noisy(value);
    (void)irq, (void)param;
    if (at_start)
        is_sample = value == 'S';
    is_sample = is_sample && byte == value; /* nobody answers a line with a wrong check */
    at_start = value == '\n';
    waits = at_start && is_sample && now < cut;
    if (now < cut && write(out, &byte, 1) != 1)
        waits = 0;
}

/* What the host has sent. */
static void listen(int patience) {
    struct pollfd port = {in, POLLIN, 0};
    while (poll(&port, 1, patience) > 0) {
        unsigned char bytes[256];
        ssize_t count = read(in, bytes, sizeof bytes), n;
        if (count <= 0) {
            if (has_host)
                seconds = fmin(seconds, now + AFTER);
            waits = 0;
            in = -1;
            return;
        }
        has_host = 1;
        for (n = 0; n < count && to < sizeof queue && now < cut; n++) {
            queue[to++] = noisy(bytes[n]);
            waits = waits && bytes[n] != '\n';
        }
        if (!waits)
            patience = 0;
    }
    waits = 0;
}

/* The share of time for which pin 9 is high. */
static double duty(const avr_t *avr) {
    const uint8_t *data = avr->data;
    int is_pwm = data[0x80] & 0x80, is_output = data[0x24] & 2, is_high = data[0x25] & 2;
    if (is_mega) { /* bit 6 of port H, and timer 2 */
        is_output = data[0x101] & 0x40, is_high = data[0x102] & 0x40;
        return data[0xB0] & 0x20 ? data[0xB4] / 255.0 : is_output && is_high;
    }
    return is_pwm ? (data[0x88] | data[0x89] << 8) / 255.0 : is_output && is_high;
}

/* Where the sketch hangs, and what stood there. */
static avr_flashaddr_t hung_at;
static uint16_t held;

/* Each millisecond. */
static avr_cycle_count_t tick(avr_t *avr, avr_cycle_count_t when, void *param) {
    double drive = duty(avr), wanted = reference(&spring, now), before = spring.mm;
    int n;
    (void)param;
    now += 1e-3;
    plant_step(&spring, drive, 1e-3);
    if (now >= jam)
        spring.mm = before;
    /* An ADC has noise of a step (5 mV). A sensor without any would look as if it stood still. */
    avr_raise_irq(adc + ADC_IRQ_ADC0, now < loose ? 500 * spring.mm + 10 * (chance() - 0.5) : 0);
    avr_raise_irq(adc + ADC_IRQ_ADC1, 500 * wanted + 10 * (chance() - 0.5));
    if (trace && (strength <= 0 || fmod(now + 5e-4, 0.01) < 1e-3))
        fprintf(trace, "%.3f,%.5f,%.5f,%.5f\n", now, wanted, spring.mm, drive);
    listen(0);
    for (n = 0; n < PER_MS && from < to; n++)
        avr_raise_irq(serial + UART_IRQ_INPUT, queue[from++]);
    if (from == to)
        from = to = 0;
    if (now >= hang) {
        hang = 1e9;
        hung_at = avr->pc;
        memcpy(&held, avr->flash + hung_at, 2);
        memcpy(avr->flash + hung_at, &(uint16_t){HANG}, 2);
    }
    if (now >= seconds)
        exit(0);
    return when + avr_usec_to_cycles(avr, 1000);
}

static void open_terminal(void) {
    struct termios raw;
    in = out = posix_openpt(O_RDWR | O_NOCTTY);
    if (in < 0 || grantpt(in) || unlockpt(in) || tcgetattr(in, &raw))
        exit(1);
    cfmakeraw(&raw);
    tcsetattr(in, TCSANOW, &raw);
    fprintf(stderr, "%s\n", ptsname(in));
    open(ptsname(in), O_RDWR | O_NOCTTY); /* stays open between two hosts */
}

static unsigned highest, lowest; /* end of the RAM, and of the stack */

static void print_stack(void) {
    fprintf(stderr, "%u\n", highest - lowest);
}

int main(int count, char **args) {
    static elf_firmware_t firmware;
    avr_t *avr;
    uint32_t flags = 0;
    unsigned last = 0;
    int n, rests = 0;
    signal(SIGPIPE, SIG_IGN);
    out = dup(1); /* the simulator says things on standard output */
    if (!freopen("/dev/null", "w", stdout))
        return 1;
    for (n = 2; n < count; n++) {
        const char *option = args[n], *value = n + 1 < count ? args[n + 1] : "";
        if (!strcmp(option, "--pty")) {
            open_terminal();
            continue;
        }
        if (!strcmp(option, "--mega")) {
            chip = "atmega2560";
            is_mega = 1;
            continue;
        }
        if (!strcmp(option, "--wire")) {
            strength = WIRE;
            continue;
        }
        if (!strcmp(option, "--stack")) {
            atexit(print_stack);
            continue;
        }
        if (!strcmp(option, "--seconds")) seconds = atof(value);
        if (!strcmp(option, "--cut")) cut = atof(value);
        if (!strcmp(option, "--hang")) hang = atof(value);
        if (!strcmp(option, "--loose")) loose = atof(value);
        if (!strcmp(option, "--jam")) jam = atof(value);
        if (!strcmp(option, "--restart")) restart = atof(value);
        if (!strcmp(option, "--strength")) strength = atof(value);
        if (!strcmp(option, "--stroke")) stroke = atof(value);
        if (!strcmp(option, "--noise")) noise = atof(value);
        if (!strcmp(option, "--trace")) trace = fopen(value, "w");
        n++;
    }
    if (count < 2 || elf_read_firmware(args[1], &firmware))
        return 2;
    avr = avr_make_mcu_by_name(chip);
    if (!avr || avr_init(avr))
        return 1;
    firmware.frequency = 16000000;
    avr->log = LOG_NONE;
    avr_load_firmware(avr, &firmware);
    avr->vcc = avr->avcc = avr->aref = 5000;
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    serial = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), 0);
    adc = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, 0);
    avr_irq_register_notify(serial + UART_IRQ_OUTPUT, said, NULL);
    highest = lowest = avr->ramend;
    plant_start(&spring, strength, stroke);
    if (trace)
        setvbuf(trace, NULL, _IOLBF, 0); /* whole, however the program ends */
    for (;;) {
        if (now >= restart) { /* the supply was too low for a moment */
            restart = 1e9;
            avr_reset(avr);
        }
        if (avr->pc == 0) {
            if (hung_at) /* the chip's watchdog has started it again */
                memcpy(avr->flash + hung_at, &held, 2);
            hung_at = 0;
            avr_cycle_timer_register_usec(avr, 1000, tick, NULL); /* a reset forgets it */
        }
        int state = avr_run(avr);
        unsigned stack = avr->data[R_SPL] | avr->data[R_SPH] << 8;
        /* Its two bytes are written one after the other. */
        rests = stack == last ? rests + 1 : 0;
        last = stack;
        if (stack < lowest && rests == 4 && stack > 0x200)
            lowest = stack;
        if (state == cpu_Done || state == cpu_Crashed)
            return state == cpu_Crashed;
        if (waits)
            listen(PATIENCE);
    }
}
