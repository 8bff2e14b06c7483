/* Steps and inverse steps of an exported model without any library: prints a hash of every bit of
 * the results. The program starts at `_start` and asks Linux to write and to end, which QEMU does
 * for a program of another processor. */
#include MODEL_HEADER

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
static char text[9] = "00000000\n";

/* A number in [0, 1), the same everywhere. */
static hys_real chance(void) {
    seed = seed * 1664525u + 1013904223u;
    return (hys_real)(int32_t)(seed >> 9) * (hys_real)1.1920929e-07;
}

static void take(hys_real x) {
    union {
        hys_real number;
        uint8_t bytes[sizeof(hys_real)];
    } bits;
    size_t n;
    bits.number = x;
    for (n = 0; n < sizeof bits.bytes; n++)
        hash = (hash ^ bits.bytes[n]) * 16777619u;
}

/* GCC calls it to copy structs, and expects it even where there is no library. */
__attribute__((optimize("no-tree-loop-distribute-patterns"))) void *memcpy(void *to, const void *from, size_t count);
void *memcpy(void *to, const void *from, size_t count) {
    unsigned char *at = to;
    const unsigned char *next = from;
    while (count-- > 0)
        *at++ = *next++;
    return to;
}

/* A call of Linux with up to three arguments. */
static long call(long number, long a, long b, long c) {
#if defined(__riscv)
    register long what __asm("a7") = number, r0 __asm("a0") = a, r1 __asm("a1") = b, r2 __asm("a2") = c;
    __asm volatile("ecall" : "+r"(r0) : "r"(what), "r"(r1), "r"(r2) : "memory");
#elif defined(__arm__)
    register long what __asm("r7") = number, r0 __asm("r0") = a, r1 __asm("r1") = b, r2 __asm("r2") = c;
    __asm volatile("svc 0" : "+r"(r0) : "r"(what), "r"(r1), "r"(r2) : "memory");
#else
    register long r0 __asm("rax") = number;
    __asm volatile("syscall" : "+r"(r0) : "D"(a), "S"(b), "d"(c) : "rcx", "r11", "memory");
#endif
    return r0;
}

#if defined(__riscv)
enum { WRITE = 64, EXIT = 93 };
#elif defined(__arm__)
enum { WRITE = 4, EXIT = 1 };
#else
enum { WRITE = 1, EXIT = 60 };
#endif

__attribute__((used)) static void run(void) {
    hys_real y = 0, x = 0;
    int n, k, found = 0;
    if (START(&MODEL, &state, turns, TURNS) != HYS_OK)
        call(EXIT, 1, 0, 0);
    for (n = 0; n < 500; n++) {
        for (k = 0; k <= (n & 3); k++) {
            (void)STEP(chance(), &y);
            take(y);
        }
        (void)INVERT(1 + 8 * chance(), &x, &found);
        take(x);
        take((hys_real)found);
    }
    for (n = 7; n >= 0; n--, hash >>= 4)
        text[n] = "0123456789abcdef"[hash & 15];
    call(WRITE, 1, (long)text, sizeof text);
    call(EXIT, 0, 0, 0);
}

/* The stack is not aligned for a function of C where a program starts. */
#if defined(__riscv)
/* The linker places data relative to a register, which is set first. */
__asm(".global _start\n_start: .option push\n.option norelax\nla gp, __global_pointer$\n.option pop\ncall run");
#elif defined(__arm__)
__asm(".syntax unified\n.thumb\n.global _start\n.thumb_func\n_start: bl run");
#else
__asm(".global _start\n_start: call run");
#endif
