/* Time of communication steps of one internal step each. Arguments: case file, number of steps per round. Prints the least
   of several rounds, in ns per call, with and without the look-up alone. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <time.h>

#include "check.h"

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

int main(int argc, char **argv)
{
    enmm_model *model = NULL;
    enmm_step_info info = {sizeof info, 0, 0, 0, 0, 0, 0, 0};
    double dt = 0, time = 0, step = 1e30, call = 1e30;
    if (argc != 3)
        return 2;
    const int count = atoi(argv[2]);
    OK(enmm_create_from_file(argv[1], &model));
    OK(enmm_start(model));
    OK(enmm_get_internal_step(model, &dt));
    for (int round = 0; round < 7; round++) {
        double begin = now();
        for (int k = 0; k < count; k++) {
            OK(enmm_do_step(model, time, dt, &info));
            time = info.time;
            if (info.steps != 1)
                CHECK(!"one internal step");
        }
        double spent = (now() - begin) / count;
        step = spent < step ? spent : step;
        begin = now();
        for (int k = 0; k < count; k++)
            OK(enmm_get_time(model, &time));
        spent = (now() - begin) / count;
        call = spent < call ? spent : call;
    }
    printf("%.1f %.1f\n", step, call);
    enmm_destroy(model);
    return CHECKS_RESULT;
}
