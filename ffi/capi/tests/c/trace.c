/* Prints the bits of all block states after every communication step, and of a run that was saved as bytes and restored.
   Arguments: case file, number of steps, step (s). */
#include <inttypes.h>
#include <stdlib.h>

#include "check.h"

static void print_states(enmm_model *model)
{
    size_t count = 0, written = 0;
    OK(enmm_block_count(model, &count));
    enmm_block_state *states = calloc(count, sizeof *states);
    states[0].struct_size = sizeof *states;
    OK(enmm_get_block_states(model, states, count, &written));
    for (size_t k = 0; k < written; k++) {
        const enmm_block_state *s = &states[k];
        const double values[] = {s->centroid_x, s->centroid_y, s->displacement_x, s->displacement_y, s->rotation,
                                 s->velocity_x, s->velocity_y, s->angular_velocity, s->mean_stress_xx, s->mean_stress_yy,
                                 s->mean_stress_xy, s->area, s->mass, s->kinetic_energy, s->strain_energy,
                                 s->penetration_max};
        printf("%" PRIu32 " %" PRIu32, s->id, s->contacts);
        for (size_t j = 0; j < sizeof values / sizeof *values; j++) {
            uint64_t bits;
            memcpy(&bits, &values[j], sizeof bits);
            printf(" %016" PRIx64, bits);
        }
        printf("\n");
    }
    free(states);
}

int main(int argc, char **argv)
{
    enmm_model *model = NULL;
    enmm_state *state = NULL;
    if (argc != 4)
        return 2;
    const int steps = atoi(argv[2]);
    const double h = strtod(argv[3], NULL);
    OK(enmm_create_from_file(argv[1], &model));
    for (int k = 0; k < steps; k++) {
        if (k == steps / 2) {
            /* The second half runs in another model that took the state as bytes. */
            size_t size = 0;
            OK(enmm_state_save(model, &state));
            OK(enmm_state_serialize(model, state, NULL, 0, &size));
            unsigned char *bytes = malloc(size);
            OK(enmm_state_serialize(model, state, bytes, size, &size));
            OK(enmm_state_free(state));
            enmm_destroy(model);
            OK(enmm_create_from_file(argv[1], &model));
            OK(enmm_state_deserialize(model, bytes, size, &state));
            OK(enmm_state_restore(model, state));
            OK(enmm_state_free(state));
            free(bytes);
        }
        OK(enmm_set_gravity(model, 0.1 * k, -9.81));
        OK(enmm_do_step(model, k * h, h, NULL));
        print_states(model);
    }
    enmm_destroy(model);
    return CHECKS_RESULT;
}
