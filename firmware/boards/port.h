/* The differences between the chips for cost.c: time, stack, printing and the end. A time is one of
 * 0.5 µs on an AVR at 16 MHz, and instructions elsewhere. */
#ifndef PORT_H
#define PORT_H
#include <stdint.h>

static void port_say(char c);

static void port_print(uint32_t x) {
    int8_t shift;
    for (shift = 28; shift >= 0; shift -= 4)
        port_say("0123456789abcdef"[x >> shift & 15]);
    port_say('\n');
}

#if defined(__AVR__)
#include <avr/io.h>

static void port_say(char c) {
    while (!(UCSR0A & _BV(UDRE0)))
        ;
    UDR0 = (uint8_t)c;
}

static void port_start(void) {
    UCSR0B = _BV(TXEN0);
    UBRR0 = 8; /* 115200 baud at 16 MHz */
    TCCR1B = _BV(CS11);
}

static uint32_t port_now(void) { return TCNT1 = 0; }
static uint32_t port_taken(uint32_t before) { return TCNT1 - before; }
static inline void port_paint(void) {}
static inline uint32_t port_stack(void) { return 0; } /* the emulator measures it */
static void port_end(void) { __asm volatile("cli\n sleep"); } /* simavr ends there */

#elif defined(__arm__) || defined(__riscv)

/* The linker's. */
extern uint32_t stack_low, stack_top;
#define PAINT 0xCCCCCCCCu

#ifdef __arm__
/* The MPS2: a timer at 25 MHz that counts down, and an instruction of 128 ns (-icount shift=7), so
 * that 5 instructions are 16 ticks. */
#define UART_DATA (*(volatile uint32_t *)0x40004000u)
#define UART_CONTROL (*(volatile uint32_t *)0x40004008u)
#define UART_DIVIDER (*(volatile uint32_t *)0x40004010u)
#define TIMER_CONTROL (*(volatile uint32_t *)0x40000000u)
#define TIMER_VALUE (*(volatile uint32_t *)0x40000004u)
#define TIMER_RELOAD (*(volatile uint32_t *)0x40000008u)

static void port_start(void) {
    UART_DIVIDER = 16;
    UART_CONTROL = 1;
    TIMER_RELOAD = 0xFFFFFFFFu;
    TIMER_VALUE = 0xFFFFFFFFu;
    TIMER_CONTROL = 1;
}

static void port_say(char c) { UART_DATA = (uint32_t)c; }
static inline uint32_t *port_pointer(void) {
    uint32_t *pointer;
    __asm volatile("mov %0, sp" : "=r"(pointer));
    return pointer;
}
__attribute__((noinline)) static uint32_t port_now(void) { return TIMER_VALUE; }
__attribute__((noinline)) static uint32_t port_taken(uint32_t before) {
    return (uint32_t)(((uint64_t)(before - TIMER_VALUE) * 5u + 8u) / 16u);
}
/* A call of the host that ends the emulator (semihosting, SYS_EXIT). */
static void port_end(void) {
    __asm volatile("movs r0, #0x18\n ldr r1, =0x20026\n bkpt 0xab" : : : "r0", "r1");
}
#else
/* QEMU's `virt`, where an instruction is a cycle (-icount shift=0). */
static void port_start(void) {}
static void port_say(char c) { *(volatile uint8_t *)0x10000000u = (uint8_t)c; }
static inline uint32_t *port_pointer(void) {
    uint32_t *pointer;
    __asm volatile("mv %0, sp" : "=r"(pointer));
    return pointer;
}
__attribute__((noinline)) static uint32_t port_now(void) {
    uint32_t count;
    __asm volatile(".option push\n.option arch, +zicsr\ncsrr %0, mcycle\n.option pop" : "=r"(count));
    return count;
}
__attribute__((noinline)) static uint32_t port_taken(uint32_t before) { return port_now() - before; }
static void port_end(void) { *(volatile uint32_t *)0x100000u = 0x5555u; }
#endif

static inline void port_paint(void) {
    volatile uint32_t *word;
    for (word = &stack_low; word < port_pointer(); word++)
        *word = PAINT;
}

/* Bytes of the stack below main's that were written since. */
static inline uint32_t port_stack(void) {
    volatile uint32_t *word = &stack_low;
    while (*word == PAINT)
        word++;
    return (uint32_t)((char *)port_pointer() - (char *)word);
}

#else
#include <stdio.h>
static void port_say(char c) { putchar(c); }
static void port_start(void) {}
static uint32_t port_now(void) { return 0; }
static uint32_t port_taken(uint32_t before) { return before; }
static inline void port_paint(void) {}
static inline uint32_t port_stack(void) { return 0; }
static void port_end(void) {}
#endif
#endif
