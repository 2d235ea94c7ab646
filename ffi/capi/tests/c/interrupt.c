/* A call ends when another thread or its progress callback wants it to, and the model is as it was, to the byte. Prints
   how long it took. Argument: case file. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include "check.h"
#include "state_bytes.h"

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct stop {
    enmm_model *model;
    double at;
    atomic_bool over;
};

/* Interrupts after a while, and again until the call is over: one that comes before the call has begun is lost. */
static void *interrupt_later(void *user)
{
    struct stop *stop = user;
    struct timespec pause = {0, 200 * 1000 * 1000};
    nanosleep(&pause, NULL);
    stop->at = now();
    pause.tv_nsec = 20 * 1000 * 1000;
    while (!atomic_load(&stop->over)) {
        OK(enmm_interrupt(stop->model));
        nanosleep(&pause, NULL);
    }
    return NULL;
}

static void from_another_thread(enmm_model *model)
{
    struct stop stop = {model, 0, 0};
    enmm_step_info info = {sizeof info, 0, 0, 0, 0, 0, 0, 0}, same = info;
    pthread_t thread;
    size_t before_size = 0, after_size = 0;
    double t = 0, late;
    unsigned char *before, *after;
    OK(enmm_get_time(model, &t));
    before = bytes_of(model, &before_size);
    CHECK(pthread_create(&thread, NULL, interrupt_later, &stop) == 0);
    CHECK(enmm_do_step(model, t, 1e8, &info) == ENMM_INTERRUPTED);
    late = now() - stop.at;
    atomic_store(&stop.over, 1);
    CHECK(pthread_join(thread, NULL) == 0);
    CHECK(strstr(enmm_last_error(), "interrupted") != NULL);
    after = bytes_of(model, &after_size);
    CHECK(before_size == after_size && memcmp(before, after, before_size) == 0);
    CHECK(memcmp(&info, &same, sizeof info) == 0);
    CHECK(late < 5);
    printf("a step of 1e8 s ended %.2f ms after the interrupt\n", 1e3 * late);
    OK(enmm_interrupt(model));
    OK(enmm_do_step(model, t, 0.01, &info));
    free(before);
    free(after);
}

struct look {
    enmm_model *model;
    int count, stop_at, equilibria;
    enmm_progress last;
};

static int32_t on_progress(const enmm_progress *progress, void *user)
{
    struct look *look = user;
    double time;
    CHECK(progress->struct_size == sizeof *progress && progress->time <= progress->end);
    CHECK(progress->is_equilibrium ? progress->unbalanced >= -1 : progress->unbalanced == -1);
    CHECK(enmm_get_time(look->model, &time) == ENMM_BUSY);
    CHECK(strstr(enmm_last_error(), "of this thread") != NULL);
    CHECK(enmm_set_progress_callback(look->model, NULL, NULL) == ENMM_BUSY);
    CHECK(look->count == 0 || progress->time > look->last.time);
    look->last = *progress;
    look->equilibria += (int)progress->is_equilibrium;
    return ++look->count == look->stop_at;
}

static void by_the_callback(const char *path)
{
    struct look look = {NULL, 0, 1, 0, {0, 0, 0, 0, 0, 0}};
    enmm_model *model = NULL;
    size_t before_size = 0, after_size = 0;
    double begin, took;
    unsigned char *before, *after;
    OK(enmm_create_from_file(path, &model));
    look.model = model;
    before = bytes_of(model, &before_size);
    OK(enmm_set_progress_callback(model, on_progress, &look));
    CHECK(enmm_start(model) == ENMM_INTERRUPTED);
    CHECK(look.count == 1 && look.equilibria == 1 && look.last.end == 0.2);
    after = bytes_of(model, &after_size);
    CHECK(before_size == after_size && memcmp(before, after, before_size) == 0);
    look.stop_at = 0;
    OK(enmm_start(model));
    look.count = 0;
    look.stop_at = 4;
    begin = now();
    CHECK(enmm_do_step(model, 0, 1e8, NULL) == ENMM_INTERRUPTED);
    took = now() - begin;
    CHECK(look.count == 4 && look.last.end == 1e8 && took > 0.1 && took < 10);
    OK(enmm_set_progress_callback(model, NULL, NULL));
    OK(enmm_do_step(model, 0, 0.01, NULL));
    CHECK(look.count == 4);
    enmm_destroy(model);
    CHECK(enmm_interrupt(model) == ENMM_DEAD_HANDLE);
    CHECK(enmm_interrupt(NULL) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_set_progress_callback(model, on_progress, &look) == ENMM_DEAD_HANDLE);
    free(before);
    free(after);
}

int main(int argc, char **argv)
{
    enmm_model *model = NULL;
    if (argc != 2)
        return 2;
    OK(enmm_create_from_file(argv[1], &model));
    OK(enmm_start(model));
    from_another_thread(model);
    enmm_destroy(model);
    by_the_callback(argv[1]);
    return CHECKS_RESULT;
}
