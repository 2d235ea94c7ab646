/* Rock bridges that break one after the other under a growing force: events, broken length, and the same bits after a
   return to a state in the middle of the failure and in another model. Argument: a case file like
   tests/cases/bridges.toml. */
#include <stdlib.h>

#include "check.h"
#include "state_bytes.h"

enum { STEPS = 300, BRIDGES = 3 };
static const double H = 0.001;

static double broken(enmm_model *model)
{
    enmm_totals totals = {.struct_size = sizeof totals};
    OK(enmm_get_totals(model, &totals));
    return totals.broken_length;
}

static void act(enmm_model *model, int first, int last)
{
    uint32_t port, block;
    OK(enmm_find_port(model, "block", &port));
    OK(enmm_port_block(model, port, &block));
    for (int k = first; k < last; k++) {
        OK(enmm_set_block_force(model, block, 3e3 * k, 0, 0));
        OK(enmm_do_step(model, k * H, H, NULL));
    }
}

/* The first step after which some bridges have broken and some hold. */
static int middle(const char *path)
{
    enmm_model *model = NULL;
    enmm_event events[16];
    size_t count = 0;
    int half = 0, breaks = 0;
    OK(enmm_create_from_file(path, &model));
    for (int k = 0; k < STEPS; k++) {
        act(model, k, k + 1);
        if (half == 0 && broken(model) > 0)
            half = k + 1;
    }
    CHECK(half > 0 && broken(model) > 0.97 && broken(model) < 1.03);
    events[0].struct_size = sizeof events[0];
    OK(enmm_get_events(model, 0, events, 16, &count));
    for (size_t k = 0; k < count; k++)
        breaks += events[k].kind == ENMM_EVENT_BROKEN;
    CHECK(breaks == BRIDGES);
    printf("%d bridges of %.2f m have broken, the first at %.3f s\n", breaks, broken(model), half * H);
    enmm_destroy(model);
    return half;
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    const int half = middle(argv[1]);
    enmm_model *model = NULL, *other = NULL;
    enmm_state *saved = NULL, *read = NULL;
    size_t half_size, end_size;
    OK(enmm_create_from_file(argv[1], &model));
    act(model, 0, half);
    CHECK(broken(model) > 0 && broken(model) < 0.95);
    OK(enmm_state_save(model, &saved));
    unsigned char *at_half = bytes_of(model, &half_size);
    act(model, half, STEPS);
    unsigned char *at_end = bytes_of(model, &end_size);

    OK(enmm_state_restore(model, saved));
    check_bytes(model, at_half, half_size);
    act(model, half, STEPS);
    check_bytes(model, at_end, end_size);

    OK(enmm_create_from_file(argv[1], &other));
    OK(enmm_state_deserialize(other, at_half, half_size, &read));
    OK(enmm_state_restore(other, read));
    act(other, half, STEPS);
    check_bytes(other, at_end, end_size);

    OK(enmm_state_free(saved));
    OK(enmm_state_free(read));
    free(at_half);
    free(at_end);
    enmm_destroy(model);
    enmm_destroy(other);
    return CHECKS_RESULT;
}
