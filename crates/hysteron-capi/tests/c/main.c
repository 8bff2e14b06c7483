/* `program` runs everything that needs no file, `program MODEL RUN` one run of a test vector. */
#include "check.h"

int main(int count, char **arguments) {
    if (count == 3) {
        vector_run(arguments[1], arguments[2]);
    } else {
        handles();
        batches();
        memory_form();
        stages();
        control();
        misuse();
    }
    puts("ok");
    return 0;
}
