/* A bar that breaks off a wall: parts, the section that broke, and the same bits after a return across the break and in
   another model. Argument: a case file like tests/cases/breaking.toml. */
#include <stdlib.h>

#include "check.h"
#include "state_bytes.h"

enum { STEPS = 64 };
static const double H = 1.0 / 1024;

static void act(enmm_model *model, int first, int last)
{
    for (int k = first; k < last; k++)
        OK(enmm_do_step(model, k * H, H, NULL));
}

static size_t blocks(enmm_model *model)
{
    size_t count = 0, written = 0, stride = 0;
    const enmm_block_state *first = NULL;
    OK(enmm_block_count(model, &count));
    OK(enmm_view_block_states(model, &first, &stride, &written));
    CHECK(written == count);
    for (size_t k = 0; k < count; k++)
        CHECK(((const enmm_block_state *)((const char *)first + k * stride))->id == k);
    return count;
}

static void check_parts(enmm_model *model)
{
    enmm_cut cuts[4];
    double outline[256];
    size_t count = 0, most = 0;
    uint32_t port = 0, block = 9, at = 9;
    cuts[0].struct_size = sizeof cuts[0];
    OK(enmm_get_cuts(model, cuts, 4, &count));
    CHECK(count == 1 && blocks(model) == 2);
    CHECK(cuts[0].block == 0 && cuts[0].part == 1 && cuts[0].failure == ENMM_SECTION_BENT);
    CHECK(cuts[0].time > 0 && cuts[0].time < STEPS * H && cuts[0].share >= 1 && cuts[0].share < 1.2);
    CHECK(cuts[0].first_x > -0.3 && cuts[0].first_x < 0.3 && cuts[0].moment != 0);
    OK(enmm_blocks_max(model, &most));
    CHECK(most == 4);
    OK(enmm_find_port(model, "bar", &port));
    OK(enmm_port_block(model, port, &block));
    OK(enmm_find_block_at(model, 1.5, 0.5, &at));
    CHECK(block == 0 && at == 0);
    OK(enmm_find_block_at(model, -2, 0, &at));
    CHECK(at == 1);
    OK(enmm_get_block_polygon(model, 1, outline, 256, &count));
    CHECK(count >= 14);
    OK(enmm_set_block_force(model, 1, 1, 2, 3));
    double force[2] = {0}, moment = 0;
    OK(enmm_get_block_force(model, 1, force, &moment));
    CHECK(force[0] == 1 && force[1] == 2 && moment == 3);
    OK(enmm_set_block_force(model, 1, 0, 0, 0));
    CHECK(enmm_set_block_force(model, 2, 0, 0, 0) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_get_block_polygon(model, 2, outline, 256, &count) == ENMM_INVALID_ARGUMENT);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    enmm_model *model = NULL, *other = NULL;
    enmm_state *before = NULL, *read = NULL;
    size_t end_size, broken_size, count = 9;
    int half = 0;
    OK(enmm_create_from_file(argv[1], &model));
    OK(enmm_state_save(model, &before));
    CHECK(blocks(model) == 1);
    for (; half < STEPS && blocks(model) == 1; half++)
        act(model, half, half + 1);
    unsigned char *broken = bytes_of(model, &broken_size);
    act(model, half, STEPS);
    unsigned char *end = bytes_of(model, &end_size);
    check_parts(model);

    for (int k = 0; k < 3; k++) {
        OK(enmm_state_restore(model, before));
        OK(enmm_get_cuts(model, NULL, 0, &count));
        CHECK(blocks(model) == 1 && count == 0);
        act(model, 0, STEPS);
        check_bytes(model, end, end_size);
    }

    OK(enmm_create_from_file(argv[1], &other));
    OK(enmm_state_deserialize(other, broken, broken_size, &read));
    OK(enmm_state_restore(other, read));
    CHECK(blocks(other) == 2);
    act(other, half, STEPS);
    check_bytes(other, end, end_size);
    printf("the bar broke in step %d of %d\n", half, STEPS);

    OK(enmm_state_free(before));
    OK(enmm_state_free(read));
    free(broken);
    free(end);
    enmm_destroy(model);
    enmm_destroy(other);
    return CHECKS_RESULT;
}
