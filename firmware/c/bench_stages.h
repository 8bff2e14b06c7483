/* The runs of models with stages, as in rust/src/run_staged.rs. A part of bench.c. */
#ifndef BENCH_STAGES_H
#define BENCH_STAGES_H

/* Memory for weights at a load, of a state and of another one. */
#define MOST_ENTRIES ((MOST + 1) * (MOST + 2) / 2)
static hys_mixed mixed[2];
static hys_real tables[2][MOST_ENTRIES];

static void staged_start(const staged_run *r, hys_actuator_state *state, hys_turn *memory, int which) {
    must(hys_actuator_start_mixed(r->actuator, state, memory, 4 * r->levels + 8, &mixed[which], tables[which],
                                  MOST_ENTRIES));
}

static inline __attribute__((always_inline)) uint32_t staged_step(
    const staged_run *r, hys_actuator_state *state, size_t n, hys_real *result, int *status) {
    uint32_t before, after;
    int kind = r->kinds[n], code;
    hys_real value = r->values[n], load = r->loads[n], tolerance = r->tolerance;
    *status = 0;
    if (kind == FORWARD) {
        before = ticks();
        code = hys_actuator_step(state, value, load, result);
        after = ticks();
    } else {
        before = ticks();
        code = hys_actuator_inverse_step(state, value, kind, tolerance, load, result, status);
        after = ticks();
    }
    must(code);
    return instructions(before, after);
}

static void staged_restored(
    const staged_run *r, const hys_actuator_state *state, size_t n, hys_real *result, int *status) {
    static hys_turn other_turns[4 * MOST + 8];
    static hys_real points[4 * MOST + 8];
    hys_real numbers[HYS_STAGE_NUMBERS], input;
    hys_actuator_state other;
    size_t held;
    must(hys_save(&state->operators, points, sizeof points / sizeof *points, &held, &input));
    must(hys_actuator_save(state, numbers));
    staged_start(r, &other, other_turns, 1);
    must(hys_restore(&other.operators, points, held, input));
    must(hys_actuator_restore(&other, numbers));
    staged_step(r, &other, n, result, status);
}

static void one_staged(const staged_run *r) {
    hys_actuator_state state;
    tally tallies[2] = {{0, 0, 0, 0}, {0, 0, 0, 0}};
    size_t n;
    staged_start(r, &state, turns, 0);
    printf("%s %s\n", TYPE, r->name);
    for (n = 0; n < r->count; n++) {
        hys_real result, other;
        int status, other_status;
        staged_restored(r, &state, n, &other, &other_status);
        add(&tallies[r->kinds[n] != FORWARD], staged_step(r, &state, n, &result, &status), n);
        say("", result, status);
        if (memcmp(&result, &other, sizeof result) != 0 || status != other_status)
            say("restored: ", other, other_status);
    }
    note_all(tallies, r->name);
}

/* Again without printing, for the stack. */
static __attribute__((noinline)) void staged_stack(const staged_run *r) {
    hys_actuator_state state;
    size_t n, stages = sizeof state - sizeof state.operators;
    hys_real result;
    int status;
    staged_start(r, &state, turns, 0);
    stack_paint();
    for (n = 0; n < r->count; n++)
        staged_step(r, &state, n, &result, &status);
    NOTE("stack\t%s\t%s\t%lu\n", TYPE, r->name, stack_used());
    if (state.mixed != NULL)
        stages += sizeof(hys_mixed) + (r->levels + 1) * (r->levels + 2) / 2 * sizeof(hys_real);
    NOTE("ram\t%s\t%s\t%lu\t%lu\n", TYPE, r->name, (unsigned long)stages,
         (unsigned long)(sizeof state.operators + (4 * r->levels + 8) * sizeof(hys_turn)));
}

static void all_staged(void) {
    const staged_run *r;
    for (r = staged_runs; r < staged_runs + staged_run_count; r++) {
        one_staged(r);
        staged_stack(r);
    }
}

#endif
