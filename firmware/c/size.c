/* The image whose size is measured: an endless loop over nothing (WHAT 0), a forward step (1), or a
 * forward and an inverse step (2). MIXED: the weights depend on the load. */
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

#ifdef PLAIN
#include "plain.h"
#include "weights.h"
#define COUNT (LEVELS * (LEVELS + 1) / 2)
#elif defined(STAGE)
#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)
#include TEXT(STAGE.h)
#elif LEVELS == 10
#include "bench_10.h"
#elif LEVELS == 20
#include "bench_20.h"
#else
#include "bench_40.h"
#endif
#ifdef STAGE
volatile hys_real load;
#elif !defined(PLAIN)
#include "hysteron_mcu.h"
#define MODEL JOIN(bench_, LEVELS)
#endif

volatile hys_real input, output, target, tolerance;
volatile int heading, status;

int main(void) {
#if WHAT > 0
    hys_real y = 0;
#ifdef PLAIN
    static const plain_model model = {LEVELS, 20, 80, JOIN(JOIN(bench_, LEVELS), _weights)};
    static plain_state state;
    static hys_real gamma[COUNT];
    plain_start(&model, &state, gamma);
#elif defined(STAGE)
    static hys_actuator_state state;
    static hys_turn turns[4 * LEVELS + 8];
#ifdef MIXED
    static hys_mixed mixed;
    static hys_real table[(LEVELS + 1) * (LEVELS + 2) / 2];
    hys_actuator_start_mixed(&STAGE, &state, turns, 4 * LEVELS + 8, &mixed, table, sizeof table / sizeof *table);
#else
    hys_actuator_start(&STAGE, &state, turns, 4 * LEVELS + 8);
#endif
#else
    static hys_state state;
    static hys_turn turns[4 * LEVELS + 8];
    hys_start(&MODEL, &state, turns, 4 * LEVELS + 8);
#endif
#endif
    for (;;) {
#if WHAT > 0
#ifdef PLAIN
        plain_step(&state, input, &y);
#elif defined(STAGE)
        hys_actuator_step(&state, input, load, &y);
#else
        hys_step(&state, input, &y);
#endif
        output = y;
#endif
#if WHAT > 1
        int s = 0;
#ifdef PLAIN
        plain_inverse_step(&state, target, &y, &s);
#elif defined(STAGE)
        hys_actuator_inverse_step(&state, target, heading, tolerance, load, &y, &s);
#else
        hys_inverse_step(&state, target, heading, tolerance, &y, &s);
#endif
        input = y;
        status = s;
#endif
    }
}
