/* No call that fails changes a byte of the serialised state: every way to fail, wherever the model stands. Argument: a
   case file like tests/cases/small.toml. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "state_bytes.h"

enum { BLOCK, BASE, COUNT };

static unsigned char *kept = NULL;
static size_t kept_size = 0;

static void keep(enmm_model *model)
{
    free(kept);
    kept = bytes_of(model, &kept_size);
}

static int is_kept(enmm_model *model)
{
    size_t size = 0;
    unsigned char *bytes = bytes_of(model, &size);
    const int same = size == kept_size && memcmp(bytes, kept, size) == 0;
    free(bytes);
    return same;
}

#define FAILS(status, call)            \
    do {                               \
        keep(model);                   \
        CHECK((call) == ENMM_##status); \
        CHECK(is_kept(model));         \
    } while (0)

static void steps_and_inputs(enmm_model *model, double t)
{
    const uint32_t ids[] = {BASE, BLOCK}, wrong[] = {BLOCK, COUNT};
    const double some[] = {1, 2}, bad[] = {3, INFINITY};
    enmm_step_info info = {0};
    FAILS(INVALID_ARGUMENT, enmm_do_step(model, t, 0.01, &info));
    FAILS(WRONG_TIME, enmm_do_step(model, t + 0.5, 0.01, NULL));
    FAILS(WRONG_TIME, enmm_do_step(model, NAN, 0.01, NULL));
    FAILS(INVALID_ARGUMENT, enmm_do_step(model, t, 0, NULL));
    FAILS(INVALID_ARGUMENT, enmm_do_step(model, t, -0.01, NULL));
    FAILS(INVALID_ARGUMENT, enmm_do_step(model, t, INFINITY, NULL));
    FAILS(INVALID_ARGUMENT, enmm_set_gravity(model, 1, NAN));
    FAILS(INVALID_ARGUMENT, enmm_set_block_force(model, COUNT, 1, 2, 3));
    FAILS(INVALID_ARGUMENT, enmm_set_block_force(model, BLOCK, 1, 2, NAN));
    FAILS(INVALID_ARGUMENT, enmm_set_block_forces(model, wrong, 2, some, some, some));
    FAILS(INVALID_ARGUMENT, enmm_set_block_forces(model, ids, 2, some, some, bad));
    FAILS(NULL_ARGUMENT, enmm_set_block_forces(model, ids, 2, some, NULL, some));
    FAILS(INVALID_ARGUMENT, enmm_set_base_acceleration(model, 1e5, 0));
    FAILS(INVALID_ARGUMENT, enmm_set_water_level(model, INFINITY));
    FAILS(INVALID_ARGUMENT, enmm_set_boundary_traction(model, 0, 1, 1));
    FAILS(INVALID_ARGUMENT, enmm_set_boundary_traction(model, 1, 1, NAN));
    FAILS(INVALID_ARGUMENT, enmm_set_boundary_pressure(model, 9, 1));
    FAILS(INVALID_ARGUMENT, enmm_set_joint_pressure(model, 2, 1e16));
    FAILS(INVALID_ARGUMENT, enmm_set_strength_factor(model, -1));
    FAILS(INVALID_ARGUMENT, enmm_set_interpolation(model, 7));
    FAILS(INVALID_ARGUMENT, enmm_set_threads(model, 0));
}

static void views(enmm_model *model)
{
    double xy[2];
    char name[2];
    uint32_t found;
    size_t count = 0;
    enmm_port_type kind;
    enmm_port_state port = {0};
    enmm_totals totals = {0};
    enmm_energies energies = {0};
    enmm_block_state states[COUNT];
    memset(states, 0, sizeof states);
    FAILS(INVALID_ARGUMENT, enmm_get_totals(model, &totals));
    FAILS(INVALID_ARGUMENT, enmm_get_energies(model, &energies));
    FAILS(INVALID_ARGUMENT, enmm_get_block_states(model, states, COUNT, &count));
    FAILS(NULL_ARGUMENT, enmm_get_contacts(model, NULL, 0, NULL));
    FAILS(NULL_ARGUMENT, enmm_get_events(model, 0, NULL, 0, NULL));
    FAILS(BUFFER_TOO_SMALL, enmm_get_block_polygon(model, BLOCK, xy, 1, &count));
    FAILS(INVALID_ARGUMENT, enmm_get_block_polygon(model, COUNT, xy, 1, &count));
    FAILS(INVALID_ARGUMENT, enmm_get_block_hole(model, BASE, 1, xy, 1, &count));
    FAILS(INVALID_ARGUMENT, enmm_block_hole_count(model, COUNT, &count));
    FAILS(NOT_FOUND, enmm_find_block_at(model, 100, 100, &found));
    FAILS(NOT_FOUND, enmm_find_port(model, "absent", &found));
    FAILS(BUFFER_TOO_SMALL, enmm_port_name(model, 0, name, 2, &count));
    FAILS(INVALID_ARGUMENT, enmm_port_kind(model, 9, &kind));
    FAILS(INVALID_ARGUMENT, enmm_port_block(model, 9, &found));
    FAILS(INVALID_ARGUMENT, enmm_get_port_state(model, 9, &port));
    FAILS(BUFFER_TOO_SMALL, enmm_case_hash(model, name, 2, &count));
    FAILS(NULL_ARGUMENT, enmm_get_time(model, NULL));
}

static void states(enmm_model *model)
{
    enmm_state *none = NULL;
    FAILS(NULL_ARGUMENT, enmm_state_save(model, NULL));
    FAILS(NULL_ARGUMENT, enmm_state_restore(model, NULL));
    FAILS(DEAD_HANDLE, enmm_state_restore(model, (enmm_state *)model));
    FAILS(WRONG_STATE, enmm_state_deserialize(model, kept, kept_size - 1, &none));
    FAILS(NULL_ARGUMENT, enmm_state_deserialize(model, kept, kept_size, NULL));
}

static void all(enmm_model *model, double t)
{
    steps_and_inputs(model, t);
    views(model);
    states(model);
}

/* A step that runs away, with inputs that hold and with inputs that are on their way. */
static void runaway(enmm_model *model, double t)
{
    for (int mode = ENMM_INTERPOLATION_HOLD; mode <= ENMM_INTERPOLATION_LINEAR; mode++) {
        OK(enmm_set_interpolation(model, mode));
        OK(enmm_set_gravity(model, 1e4, 0));
        FAILS(NUMERICAL_FAILURE, enmm_do_step(model, t, 1, NULL));
        OK(enmm_set_gravity(model, 0, -9.81));
        OK(enmm_set_base_acceleration(model, 1e4, 0));
        FAILS(NUMERICAL_FAILURE, enmm_do_step(model, t, 1, NULL));
        OK(enmm_set_base_acceleration(model, 0, 0));
    }
    OK(enmm_set_interpolation(model, ENMM_INTERPOLATION_HOLD));
}

int main(int argc, char **argv)
{
    enmm_model *model = NULL;
    double step = 0;
    if (argc != 2)
        return 2;
    OK(enmm_create_from_file(argv[1], &model));
    all(model, 0);
    OK(enmm_set_block_force(model, BLOCK, 1e12, 0, 0));
    FAILS(NUMERICAL_FAILURE, enmm_start(model));
    FAILS(NUMERICAL_FAILURE, enmm_do_step(model, 0, 0.01, NULL));
    OK(enmm_set_block_force(model, BLOCK, 100, 0, 0));
    OK(enmm_set_water_level(model, 0.3));
    all(model, 0);
    OK(enmm_set_base_acceleration(model, 1e4, 0));
    FAILS(NUMERICAL_FAILURE, enmm_do_step(model, 0, 1, NULL)); /* the equilibrium is found, and taken back */
    OK(enmm_set_base_acceleration(model, 0, 0));
    OK(enmm_start(model));
    runaway(model, 0);
    OK(enmm_get_internal_step(model, &step));
    OK(enmm_do_step(model, 0, 2.5 * step, NULL)); /* between two internal steps */
    all(model, 2.5 * step);
    runaway(model, 2.5 * step);
    OK(enmm_do_step(model, 2.5 * step, 0.01, NULL));
    enmm_destroy(model);
    free(kept);
    return CHECKS_RESULT;
}
