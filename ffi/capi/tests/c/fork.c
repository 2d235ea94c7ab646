/* A model that has used threads goes on in a forked process, with the bits of a model without threads. A process that
   waits for threads that it does not have is ended by its alarm. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"

static const double H = 1e-4;

/* More than 4096 covers, so that a step is worth threads. */
static const char *const PLATE =
    "title = \"Plate\"\n[domain]\noutline = [[0, 0], [1, 0], [1, 1], [0, 1]]\n[mesh]\nsize = 0.014\n"
    "[rock.rock]\ndensity = 2500\nyoung = 1e9\npoisson = 0.25\n[[fix]]\nedge = [[0, 0], [1, 0]]\n"
    "[[stage]]\nname = \"shake\"\nkind = \"dynamic\"\nduration = 1\n";

struct bytes {
    unsigned char *data;
    size_t size;
};

static struct bytes state_of(enmm_model *model)
{
    struct bytes bytes = {NULL, 0};
    enmm_state *state = NULL;
    OK(enmm_state_save(model, &state));
    OK(enmm_state_serialize(model, state, NULL, 0, &bytes.size));
    bytes.data = malloc(bytes.size);
    OK(enmm_state_serialize(model, state, bytes.data, bytes.size, &bytes.size));
    OK(enmm_state_free(state));
    return bytes;
}

static enmm_model *create(size_t threads)
{
    enmm_model *model = NULL;
    OK(enmm_create_from_string(PLATE, NULL, &model));
    OK(enmm_set_threads(model, threads));
    OK(enmm_do_step(model, 0, H, NULL));
    return model;
}

/* Looks at the model, takes its second step and compares it with what must come. */
static void go_on(enmm_model *model, const struct bytes *expected)
{
    enmm_totals totals = {0};
    struct bytes now;
    size_t count = 0;
    totals.struct_size = sizeof totals;
    OK(enmm_get_totals(model, &totals));
    CHECK(totals.velocity_max > 0);
    OK(enmm_get_contacts(model, NULL, 0, &count));
    OK(enmm_do_step(model, H, H, NULL));
    OK(enmm_get_totals(model, &totals));
    now = state_of(model);
    CHECK(now.size == expected->size && memcmp(now.data, expected->data, now.size) == 0);
    free(now.data);
}

/* Does its work in a forked process; `work` 0 only ends the model, which ends no threads there. */
static void in_a_child(enmm_model *model, const struct bytes *expected, int work)
{
    int status = -1;
    const pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        alarm(60);
        if (work)
            go_on(model, expected);
        enmm_destroy(model);
        _exit(CHECKS_RESULT);
    }
    CHECK(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

int main(void)
{
    enmm_model *alone = create(1), *model = create(2);
    struct bytes expected;
    enmm_totals totals = {0};
    totals.struct_size = sizeof totals;
    OK(enmm_get_totals(model, &totals));
    OK(enmm_do_step(alone, H, H, NULL));
    expected = state_of(alone);
    in_a_child(model, &expected, 1);
    in_a_child(model, &expected, 0);
    alarm(60);
    go_on(model, &expected);
    enmm_destroy(model);
    enmm_destroy(alone);
    free(expected.data);
    return CHECKS_RESULT;
}
