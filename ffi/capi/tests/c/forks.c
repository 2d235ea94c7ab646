/* Two threads fork while three others make, use and save models. Every forked process uses a model, makes one or saves
   a state; one that waits for a thread that it does not have is ended by its alarm.
   forks CASE NUMBER */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"

enum { USERS = 3, FORKERS = 2, KINDS = 3 };

static const char *path;
static int number;
static atomic_int stop;
static enmm_model *used[USERS], *own[FORKERS];
static atomic_int hung[KINDS], failed[KINDS], done[KINDS];

static enmm_status look(enmm_model *model)
{
    double time = 0;
    const enmm_status status = enmm_get_time(model, &time);
    return status == ENMM_OK ? enmm_do_step(model, time, 1e-3, NULL) : status;
}

static enmm_status make(void)
{
    enmm_model *model = NULL;
    const enmm_status status = enmm_create_from_file(path, &model);
    enmm_destroy(model);
    return status;
}

static enmm_status save(enmm_model *model)
{
    enmm_state *state = NULL;
    size_t size = 0;
    enmm_status status = enmm_state_save(model, &state);
    if (status == ENMM_OK)
        status = enmm_state_serialize(model, state, NULL, 0, &size);
    if (status == ENMM_OK)
        status = enmm_state_free(state);
    return status;
}

static enmm_status act(int kind, enmm_model *model)
{
    return kind == 0 ? look(model) : kind == 1 ? make() : save(model);
}

static void *user(void *argument)
{
    const int k = (int)(size_t)argument;
    while (!stop)
        act(k, used[k]);
    return NULL;
}

static void *forker(void *argument)
{
    const int k = (int)(size_t)argument;
    for (int i = k; i < number; i += FORKERS) {
        const int kind = i / FORKERS % KINDS;
        int status = 0;
        const pid_t child = fork();
        if (child == 0) {
            alarm(20);
            _exit(act(kind, own[k]) != ENMM_OK);
        }
        if (child < 0 || waitpid(child, &status, 0) != child || (WIFEXITED(status) && WEXITSTATUS(status)))
            failed[kind]++;
        else if (WIFSIGNALED(status))
            hung[kind]++;
        else
            done[kind]++;
    }
    return NULL;
}

int main(int argc, char **argv)
{
    pthread_t threads[USERS + FORKERS];
    int all = 0;
    CHECK(argc == 3);
    path = argv[1];
    number = atoi(argv[2]);
    for (int k = 0; k < USERS; k++)
        OK(enmm_create_from_file(path, &used[k]));
    for (int k = 0; k < FORKERS; k++)
        OK(enmm_create_from_file(path, &own[k]));
    for (int k = 0; k < USERS; k++)
        CHECK(pthread_create(&threads[k], NULL, user, (void *)(size_t)k) == 0);
    for (int k = 0; k < FORKERS; k++)
        CHECK(pthread_create(&threads[USERS + k], NULL, forker, (void *)(size_t)k) == 0);
    for (int k = 0; k < FORKERS; k++)
        pthread_join(threads[USERS + k], NULL);
    stop = 1;
    for (int k = 0; k < USERS; k++)
        pthread_join(threads[k], NULL);
    for (int kind = 0; kind < KINDS; kind++) {
        all += done[kind];
        CHECK(hung[kind] == 0 && failed[kind] == 0 && done[kind] > 0);
    }
    CHECK(all == number);
    printf("%d forks beside %d threads: steps %d, models %d, states %d; hung %d\n", number, USERS, done[0], done[1],
           done[2], hung[0] + hung[1] + hung[2]);
    return CHECKS_RESULT;
}
