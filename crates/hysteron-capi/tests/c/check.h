/* What the parts of the test program share. */
#ifndef CHECK_H
#define CHECK_H

#include "hysteron.h"
#include <stdio.h>
#include <stdlib.h>

#define REQUIRE(condition)                                                                         \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            char detail[256];                                                                      \
            hysteron_last_error(detail, sizeof detail);                                            \
            fprintf(stderr, "%s:%d: %s\n(last error: %s)\n", __FILE__, __LINE__, #condition, detail); \
            exit(1);                                                                               \
        }                                                                                          \
    } while (0)

#define OK(call) REQUIRE((call) == HYSTERON_OK)

/* Aligned as the library asks for it. */
static inline void *room(size_t bytes) {
    void *memory;
    REQUIRE(bytes > 0);
    memory = malloc(bytes);
    REQUIRE(memory != NULL);
    return memory;
}

void vector_run(const char *model_file, const char *run_file);
void vector_stages(uint64_t model, uint64_t state, FILE *file);
void handles(void);
void batches(void);
void memory_form(void);
void stages(void);
void control(void);
void misuse(void);

#endif
