/* Models side by side in threads give the bits of one after the other; a model that two threads want is an error for one;
   a model may be destroyed while it steps; until its messages are out it is the thread's that it speaks on. Argument: case
   file. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <time.h>
#include <stdlib.h>

#include "check.h"

enum { STEPS = 40, BLOCKS = 64 };

struct job {
    const char *path;
    double gravity;
    enmm_block_state states[BLOCKS];
    size_t count;
    int failed;
};

static void *run(void *user)
{
    struct job *job = user;
    enmm_model *model = NULL;
    enmm_status status = enmm_create_from_file(job->path, &model);
    if (status == ENMM_OK)
        status = enmm_set_gravity(model, job->gravity, -9.81);
    for (int k = 0; status == ENMM_OK && k < STEPS; k++)
        status = enmm_do_step(model, 0.01 * k, 0.01, NULL);
    job->states[0].struct_size = sizeof job->states[0];
    if (status == ENMM_OK)
        status = enmm_get_block_states(model, job->states, BLOCKS, &job->count);
    enmm_destroy(model);
    job->failed = status != ENMM_OK;
    return NULL;
}

struct shared {
    enmm_model *model;
    long done, busy, dead, other;
};

static void *use(void *user)
{
    struct shared *shared = user;
    for (;;) {
        double time = 0;
        enmm_status status = enmm_get_time(shared->model, &time);
        if (status == ENMM_OK)
            status = enmm_do_step(shared->model, time, 0.01, NULL);
        shared->done += status == ENMM_OK;
        shared->busy += status == ENMM_BUSY;
        shared->dead += status == ENMM_DEAD_HANDLE;
        shared->other += status != ENMM_OK && status != ENMM_BUSY && status != ENMM_WRONG_TIME && status != ENMM_DEAD_HANDLE;
        if (status == ENMM_DEAD_HANDLE)
            return NULL;
    }
}

static void side_by_side(const char *path)
{
    static struct job alone[2], together[2];
    pthread_t threads[2];
    for (int k = 0; k < 2; k++) {
        alone[k].path = together[k].path = path;
        alone[k].gravity = together[k].gravity = k;
        run(&alone[k]);
    }
    for (int k = 0; k < 2; k++)
        CHECK(pthread_create(&threads[k], NULL, run, &together[k]) == 0);
    for (int k = 0; k < 2; k++) {
        pthread_join(threads[k], NULL);
        CHECK(!alone[k].failed && !together[k].failed && alone[k].count > 0);
        CHECK(memcmp(alone[k].states, together[k].states, sizeof alone[k].states) == 0);
    }
    CHECK(memcmp(alone[0].states, alone[1].states, sizeof alone[0].states) != 0);
}

static void in_each_others_way(const char *path)
{
    struct shared shared[2] = {{0}};
    enmm_model *model = NULL;
    pthread_t threads[2];
    struct timespec moment = {0, 200000000};
    OK(enmm_create_from_file(path, &model));
    OK(enmm_start(model));
    for (int k = 0; k < 2; k++) {
        shared[k].model = model;
        CHECK(pthread_create(&threads[k], NULL, use, &shared[k]) == 0);
    }
    nanosleep(&moment, NULL);
    enmm_destroy(model);
    for (int k = 0; k < 2; k++) {
        pthread_join(threads[k], NULL);
        CHECK(shared[k].dead == 1 && shared[k].other == 0);
    }
    CHECK(shared[0].done + shared[1].done > 0);
    printf("two threads, one model: %ld steps, %ld times busy\n", shared[0].done + shared[1].done,
           shared[0].busy + shared[1].busy);
}

/* A callback that waits in its first message until it is let go. */
struct speaker {
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    enmm_model *model;
    int messages, speaking, let_go;
    enmm_status step;
};

static void wait_for(struct speaker *speaker, const int *flag)
{
    pthread_mutex_lock(&speaker->mutex);
    while (!*flag)
        pthread_cond_wait(&speaker->changed, &speaker->mutex);
    pthread_mutex_unlock(&speaker->mutex);
}

static void raise_flag(struct speaker *speaker, int *flag)
{
    pthread_mutex_lock(&speaker->mutex);
    *flag = 1;
    pthread_cond_broadcast(&speaker->changed);
    pthread_mutex_unlock(&speaker->mutex);
}

static void on_message(void *user, enmm_log_level level, const char *message)
{
    struct speaker *speaker = user;
    (void)level;
    (void)message;
    speaker->messages++;
    raise_flag(speaker, &speaker->speaking);
    wait_for(speaker, &speaker->let_go);
}

static void *leap(void *user)
{
    struct speaker *speaker = user;
    speaker->step = enmm_do_step(speaker->model, 0, 0.2, NULL);
    return NULL;
}

/* Messages go out on one thread, another wants to take the callback away, and succeeds when they are out, or destroys. */
static void while_it_speaks(const char *path, int destroy)
{
    struct speaker speaker = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, NULL, 0, 0, 0, ENMM_PANIC};
    enmm_model *model = NULL;
    pthread_t thread;
    double time;
    OK(enmm_create_from_file(path, &model));
    OK(enmm_start(model));
    OK(enmm_set_gravity(model, 20, -9.81));
    OK(enmm_set_log_callback(model, on_message, &speaker));
    speaker.model = model;
    CHECK(pthread_create(&thread, NULL, leap, &speaker) == 0);
    wait_for(&speaker, &speaker.speaking);
    CHECK(enmm_set_log_callback(model, NULL, NULL) == ENMM_BUSY);
    CHECK(enmm_get_time(model, &time) == ENMM_BUSY);
    if (destroy)
        enmm_destroy(model);
    raise_flag(&speaker, &speaker.let_go);
    pthread_join(thread, NULL);
    CHECK(speaker.step == ENMM_OK);
    CHECK(destroy ? speaker.messages == 1 : speaker.messages >= 2);
    CHECK(enmm_set_log_callback(model, NULL, NULL) == (destroy ? ENMM_DEAD_HANDLE : ENMM_OK));
    enmm_destroy(model);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    side_by_side(argv[1]);
    in_each_others_way(argv[1]);
    while_it_speaks(argv[1], 0);
    while_it_speaks(argv[1], 1);
    return CHECKS_RESULT;
}
