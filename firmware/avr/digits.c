/* Steps and inverse steps of an exported model, on the chip and on the host: a hash of every bit of
 * the results. On the chip also the cycles that one call took at most. */
#include MODEL_HEADER
#include <stdint.h>
#include <string.h>

#ifdef STAGED
#define STATE hys_actuator_state
#define START hys_actuator_start
#define STEP(x, y) hys_actuator_step(&state, x, 0, y)
#define INVERT(y, x, found) hys_actuator_inverse_step(&state, y, HYS_HOLD, 0, 0, x, found)
#else
#define STATE hys_state
#define START hys_start
#define STEP(x, y) hys_step(&state, x, y)
#define INVERT(y, x, found) hys_inverse_step(&state, y, HYS_HOLD, 0, x, found)
#endif

static hys_turn turns[TURNS];
static STATE state;
static uint32_t hash = 2166136261u, seed = 1;

/* A number in [0, 1), the same everywhere. */
static hys_real chance(void) {
    seed = seed * 1664525u + 1013904223u;
    return (hys_real)(int32_t)(seed >> 9) * (hys_real)1.1920929e-07;
}

static void take(hys_real x) {
    uint8_t bytes[sizeof x], n;
    memcpy(bytes, &x, sizeof x);
    for (n = 0; n < sizeof x; n++)
        hash = (hash ^ bytes[n]) * 16777619u;
}

#ifdef __AVR__
#include <avr/io.h>

static void say(uint8_t byte) {
    while (!(UCSR0A & _BV(UDRE0)))
        ;
    UDR0 = byte;
}

static void print(uint32_t x) {
    int8_t shift;
    for (shift = 28; shift >= 0; shift -= 4)
        say("0123456789abcdef"[x >> shift & 15]);
    say('\n');
}

/* Cycles of a call: timer 1 counts them. */
#define BEGIN TCNT1 = 0
#define END(most) do { uint16_t now = TCNT1; if (now > most) most = now; } while (0)

#else
#include <stdio.h>
static void print(uint32_t x) { printf("%08lx\n", (unsigned long)x); }
#define BEGIN
#define END(most) ((void)0)
#endif

int main(void) {
    uint16_t steps = 0, inverses = 0, n;
    hys_real x, y = 0, found_at = 0;
    int found = 0;
#ifdef __AVR__
    UCSR0B = _BV(TXEN0);
    UBRR0 = 8; /* 115200 baud at 16 MHz */
    TCCR1B = _BV(CS10);
#endif
    if (START(&MODEL, &state, turns, TURNS) != HYS_OK)
        return 1;
    for (n = 0; n < 2500; n++) {
        uint8_t k, burst = 1 + (uint8_t)(n & 3);
        for (k = 0; k < burst; k++) {
            x = LOW + (HIGH - LOW) * chance();
            BEGIN;
            (void)STEP(x, &y);
            END(steps);
            take(y);
        }
        y = OFF + (ON - OFF) * chance();
        BEGIN;
        (void)INVERT(y, &found_at, &found);
        END(inverses);
        take(found_at);
        take((hys_real)found);
    }
    print(hash);
    print(steps);
    print(inverses);
#ifdef __AVR__
    __asm volatile("cli\n sleep"); /* simavr ends there */
#endif
    return 0;
}
