/* Every run in one number type, as in rust/src/run.rs: through the exported C or, with PLAIN,
 * through the plain loop. Standard output gets the bits of each result. On the Cortex-M4F, standard
 * error gets the cost. */
#include "board.h"
#include "run.h"
#include <string.h>

#define TYPE (sizeof(hys_real) == sizeof(float) ? "float" : "double")

#ifdef PLAIN

#define PLAIN_LOOP 1
typedef plain_state state_type;
static hys_real gammas[MOST * (MOST + 1) / 2];

static int begin(const run *r, state_type *state) {
    plain_start(r->model, state, gammas);
    return 0;
}

static int forward(state_type *state, hys_real input, hys_real *output) {
    plain_step(state, input, output);
    return 0;
}

static int inverse(state_type *state, hys_real target, int heading, hys_real tolerance, hys_real *input, int *status) {
    (void)heading, (void)tolerance;
    plain_inverse_step(state, target, input, status);
    return 0;
}

static size_t state_size(size_t levels) { return sizeof(state_type) + levels * (levels + 1) / 2 * sizeof(hys_real); }

#else

#define PLAIN_LOOP 0
typedef hys_state state_type;
static hys_turn turns[4 * MOST + 8];

static int begin(const run *r, state_type *state) { return hys_start(r->model, state, turns, 4 * r->levels + 8); }

#define forward hys_step
#define inverse hys_inverse_step

static size_t state_size(size_t levels) { return sizeof(state_type) + (4 * levels + 8) * sizeof(hys_turn); }

#endif

static void must(int code) {
    if (code == 0)
        return;
    printf("code %d\n", code);
    exit(1);
}

/* One step, and its number of instructions. */
static inline __attribute__((always_inline)) uint32_t step(
    const run *r, state_type *state, size_t n, hys_real *result, int *status) {
    uint32_t before, after;
    int kind = r->kinds[n], code;
    hys_real value = r->values[n], tolerance = r->tolerance;
    *status = 0;
    if (kind == FORWARD) {
        before = ticks();
        code = forward(state, value, result);
        after = ticks();
    } else {
        before = ticks();
        code = inverse(state, value, kind, tolerance, result, status);
        after = ticks();
    }
    must(code);
    return instructions(before, after);
}

static void say(const char *before, hys_real result, int status) {
    uint32_t words[sizeof result / sizeof(uint32_t)];
    size_t n = sizeof words / sizeof *words;
    memcpy(words, &result, sizeof result);
    printf("%s", before);
    while (n-- > 0)
        printf("%08lx", (unsigned long)words[n]);
    printf(" %d\n", status);
}

/* A state that was saved and restored before a step has to give the same result. */
static void step_restored(const run *r, const state_type *state, size_t n, hys_real *result, int *status) {
#ifdef PLAIN
    (void)r, (void)state, (void)n, (void)result, (void)status;
#else
    static hys_turn other_turns[4 * MOST + 8];
    static hys_real points[4 * MOST + 8];
    state_type other;
    size_t held;
    hys_real input;
    must(hys_save(state, points, sizeof points / sizeof *points, &held, &input));
    must(hys_start(r->model, &other, other_turns, 4 * r->levels + 8));
    must(hys_restore(&other, points, held, input));
    step(r, &other, n, result, status);
#endif
}

/* Number of steps of one kind, instructions of all, the most in one step, and its index. */
typedef struct {
    unsigned long steps;
    unsigned long long sum;
    unsigned long most;
    size_t which;
} tally;

static void add(tally *t, uint32_t taken, size_t n) {
    t->steps++;
    t->sum += taken;
    if (taken > t->most) {
        t->most = taken;
        t->which = n;
    }
}

static void note_all(const tally *tallies, const char *name) {
    size_t n;
    for (n = 0; n < 2; n++)
        if (tallies[n].steps > 0)
            NOTE("steps\t%s\t%s\t%s\t%lu\t%llu\t%lu\t%lu\n", TYPE, name, n == 0 ? "forward" : "inverse",
                 tallies[n].steps, tallies[n].sum, tallies[n].most, (unsigned long)tallies[n].which);
    (void)name;
}

static void one(const run *r) {
    state_type state;
    tally tallies[2] = {{0, 0, 0, 0}, {0, 0, 0, 0}};
    size_t n;
    must(begin(r, &state));
    printf("%s %s\n", TYPE, r->name);
    for (n = 0; n < r->count; n++) {
        hys_real result, other;
        int status, other_status;
        step_restored(r, &state, n, &other, &other_status);
        add(&tallies[r->kinds[n] != FORWARD], step(r, &state, n, &result, &status), n);
        say("", result, status);
#ifndef PLAIN
        if (memcmp(&result, &other, sizeof result) != 0 || status != other_status)
            say("restored: ", other, other_status);
#endif
    }
    note_all(tallies, r->name);
}

/* Again without printing, for the stack. */
static __attribute__((noinline)) void stack(const run *r) {
    state_type state;
    /* The plain loop is slow, and its use of the stack does not depend on the input. */
    size_t n, count = PLAIN_LOOP && r->count > 50 ? 50 : r->count;
    hys_real result;
    int status;
    must(begin(r, &state));
    stack_paint();
    for (n = 0; n < count; n++)
        step(r, &state, n, &result, &status);
    NOTE("stack\t%s\t%s\t%lu\n", TYPE, r->name, stack_used());
    NOTE("ram\t%s\t%s\t0\t%lu\n", TYPE, r->name, (unsigned long)state_size(r->levels));
}

#ifndef PLAIN
#include "bench_stages.h"
#endif

int main(void) {
    const run *r;
    board_start();
    for (r = runs; r < runs + run_count; r++) {
        one(r);
        stack(r);
    }
#ifndef PLAIN
    all_staged();
#endif
    return 0;
}
