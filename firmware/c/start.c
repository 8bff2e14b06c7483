/* Vector table and reset: enables the FPU, then goes to main. */
#include <stdint.h>
#include <stdlib.h>

extern uint32_t stack_top;
extern uint32_t bss_start, bss_end;
int main(void);
void reset(void);
#ifdef SEMIHOSTED
void initialise_monitor_handles(void);

/* Needed by newlib's exit(). The compiler's start-up files, which have it, are left out. */
void _fini(void);
void _fini(void) {}
#endif

static void hang(void) {
    for (;;) {
    }
}

/* What a watchdog calls before it starts the chip again. */
void not_masked(void);
__attribute__((weak)) void not_masked(void) { hang(); }

struct vectors {
    uint32_t *stack;
    void (*handler[15])(void);
};

__attribute__((section(".vectors"), used)) static const struct vectors vectors = {
    &stack_top,
    {reset, not_masked, hang, hang, hang, hang, hang, hang, hang, hang, hang, hang, hang, hang, hang},
};

#define CPACR (*(volatile uint32_t *)0xE000ED88u) /* coprocessor access */

void reset(void) {
    uint32_t *word;
    CPACR |= 0xFu << 20; /* coprocessors 10 and 11 are the FPU */
    __asm volatile("dsb\n isb");
    for (word = &bss_start; word < &bss_end; word++)
        *word = 0;
#ifdef SEMIHOSTED
    initialise_monitor_handles();
    exit(main());
#else
    main();
    hang();
#endif
}
