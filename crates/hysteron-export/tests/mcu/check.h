#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>

/* In main: ends the program where something does not hold, and says what. */
#define CHECK(what)                                              \
    do {                                                         \
        if (!(what)) {                                           \
            fprintf(stderr, "line %d: %s\n", __LINE__, #what);   \
            return 1;                                            \
        }                                                        \
    } while (0)

#endif
