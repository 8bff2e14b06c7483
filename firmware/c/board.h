/* The differences between the Cortex-M4F and the host: counting instructions, measuring the stack.
 */
#ifndef BOARD_H
#define BOARD_H
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef __arm__

/* A 32-bit timer at 25 MHz that counts down (CMSDK APB timer 0). With `-icount shift=7` an
 * instruction takes 128 ns. A tick is 40 ns, so 5 instructions are 16 ticks. A difference of two
 * readings is off by less than one tick, so it gives the number of instructions exactly. */
#define TIMER_CONTROL (*(volatile uint32_t *)0x40000000u)
#define TIMER_VALUE (*(volatile uint32_t *)0x40000004u)
#define TIMER_RELOAD (*(volatile uint32_t *)0x40000008u)

static uint32_t reading; /* the count for an empty step */

/* A separate function, so that the compiler moves nothing of the step past a reading. */
__attribute__((noinline)) static uint32_t ticks(void) { return TIMER_VALUE; }

static uint32_t instructions(uint32_t before, uint32_t after) {
    return (uint32_t)(((uint64_t)(before - after) * 5u + 8u) / 16u) - reading;
}

#define NOPS(n) \
    do { \
        uint32_t before = ticks(), counted; \
        __asm volatile(".rept " #n "\n nop\n .endr"); \
        counted = instructions(before, ticks()); \
        fprintf(stderr, "exact\t%d\t%lu\n", n, (unsigned long)counted); \
        if (counted != n) \
            exit(1); \
    } while (0)

/* Starts the counter and checks it. */
static void board_start(void) {
    uint32_t before;
    TIMER_RELOAD = 0xFFFFFFFFu;
    TIMER_VALUE = 0xFFFFFFFFu;
    TIMER_CONTROL = 1u;
    before = ticks();
    reading = instructions(before, ticks());
    NOPS(0);
    NOPS(1);
    NOPS(2);
    NOPS(3);
    NOPS(10);
    NOPS(1000);
}

extern uint32_t stack_low;
#define PAINT 0xCCCCCCCCu

static uint32_t *stack_pointer(void) {
    uint32_t *pointer;
    __asm volatile("mov %0, sp" : "=r"(pointer));
    return pointer;
}

static void stack_paint(void) {
    volatile uint32_t *word;
    for (word = &stack_low; word < stack_pointer(); word++)
        *word = PAINT;
}

/* Bytes of the stack below the caller's own that were written since it was painted. */
static unsigned long stack_used(void) {
    volatile uint32_t *word = &stack_low;
    while (*word == PAINT)
        word++;
    return (unsigned long)((char *)stack_pointer() - (char *)word);
}

#define NOTE(...) fprintf(stderr, __VA_ARGS__)

#else

static uint32_t ticks(void) { return 0; }
static uint32_t instructions(uint32_t before, uint32_t after) { return before - after; }
static void board_start(void) {}
static void stack_paint(void) {}
static unsigned long stack_used(void) { return 0; }
#define NOTE(...) ((void)(0 && fprintf(stderr, __VA_ARGS__)))

#endif
#endif
