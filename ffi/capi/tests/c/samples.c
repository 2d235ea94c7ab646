/* Parameters by name, inputs that are read, blocks in place, models and samples together: as the same calls one by one. */
#include <math.h>
#include <stdlib.h>

#include "check.h"

#define SAMPLES 5
#define STEPS 4
#define OUTPUTS 2

static enmm_model *create(const char *path)
{
    enmm_model *model = NULL;
    OK(enmm_create_from_file(path, &model));
    OK(enmm_start(model));
    return model;
}

/* Displacements x, y of the block after steps of 0.01 s from where the model stands. */
static void moved(enmm_model *model, int steps, double out[OUTPUTS])
{
    enmm_port_state state;
    double t;
    memset(&state, 0, sizeof state);
    state.struct_size = sizeof state;
    for (int k = 0; k < steps; k++) {
        OK(enmm_get_time(model, &t));
        OK(enmm_do_step(model, t, 0.01, NULL));
    }
    OK(enmm_get_port_state(model, 0, &state));
    out[0] = state.displacement_x;
    out[1] = state.displacement_y;
}

static void check_parameters(enmm_model *model, uint32_t friction)
{
    char text[80];
    size_t count, written;
    double low, high, value;
    int32_t tunable;
    uint32_t young;
    OK(enmm_parameter_count(model, &count));
    CHECK(count > 3 && friction < count);
    OK(enmm_parameter_name(model, friction, text, sizeof text, &written));
    CHECK(strcmp(text, "joint_law.joint.friction") == 0 && written == strlen(text) + 1);
    OK(enmm_parameter_unit(model, friction, text, sizeof text, &written));
    CHECK(strcmp(text, "rad") == 0);
    OK(enmm_parameter_description(model, friction, text, sizeof text, &written));
    CHECK(strstr(text, "riction") != NULL);
    OK(enmm_parameter_range(model, friction, &low, &high, &tunable));
    CHECK(low == 0 && high > 1 && tunable == 1);
    OK(enmm_parameter_range(model, friction, NULL, NULL, NULL));
    OK(enmm_get_parameter(model, friction, &value));
    CHECK(fabs(value - 0.5235987755982988) < 1e-15);
    CHECK(enmm_set_parameter(model, friction, -1) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_parameter(model, 1000, 0.1) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_find_parameter(model, "joint_law.other.friction", &young) == ENMM_NOT_FOUND);
    CHECK(strstr(enmm_last_error(), "joint_law.joint.friction") != NULL);
    OK(enmm_find_parameter(model, "rock.rock.young", &young));
    CHECK(enmm_set_parameter(model, young, 2e9) == ENMM_INVALID_ARGUMENT);
    {
        const uint32_t both[2] = {friction, young};
        const double values[2] = {0.1, 2e9};
        CHECK(enmm_set_parameters(model, both, 2, values) == ENMM_INVALID_ARGUMENT);
        OK(enmm_get_parameter(model, friction, &value));
        CHECK(value > 0.5);
    }
}

static void check_inputs(enmm_model *model)
{
    double gravity[2], base[2], level, factor, force[2], moment, traction[2], pressure, velocity[2];
    OK(enmm_set_block_force(model, 1, 1, 2, 3));
    OK(enmm_set_boundary_traction(model, 1, 4, 5));
    OK(enmm_set_boundary_pressure(model, 1, 6));
    OK(enmm_get_inputs(model, gravity, base, &level, &factor));
    CHECK(gravity[0] == 0 && gravity[1] == -9.81 && base[0] == 0 && base[1] == 0 && level == 0.25 && factor == 1);
    OK(enmm_get_block_force(model, 1, force, &moment));
    CHECK(force[0] == 1 && force[1] == 2 && moment == 3);
    OK(enmm_get_port_inputs(model, 1, traction, &pressure, velocity));
    CHECK(traction[0] == 4 && traction[1] == 5 && pressure == 6 && velocity[0] == 0 && velocity[1] == 0);
    CHECK(enmm_get_block_force(model, 99, force, &moment) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_get_port_inputs(model, 99, NULL, NULL, NULL) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_port_velocity(model, 0, 1, 0) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_port_displacement(model, 0, 1, 0) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_input_interpolation(model, ENMM_INPUT_PORT, 1, ENMM_INTERPOLATION_LINEAR));
    CHECK(enmm_set_input_interpolation(model, ENMM_INPUT_BLOCK, 99, 0) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_input_interpolation(model, 9, 0, 0) == ENMM_INVALID_ARGUMENT);
    OK(enmm_jump(model));
    OK(enmm_set_interpolation(model, ENMM_INTERPOLATION_HOLD));
    OK(enmm_set_block_force(model, 1, 0, 0, 0));
    OK(enmm_set_boundary_traction(model, 1, 0, 0));
    OK(enmm_set_boundary_pressure(model, 1, 0));
}

static void check_view(enmm_model *model)
{
    const enmm_block_state *first = NULL;
    size_t stride = 0, count = 0, written;
    enmm_block_state copies[4];
    memset(copies, 0, sizeof copies);
    copies[0].struct_size = sizeof copies[0];
    OK(enmm_get_block_states(model, copies, 4, &written));
    OK(enmm_view_block_states(model, &first, &stride, &count));
    CHECK(count == written && stride == sizeof copies[0]);
    for (size_t k = 0; k < count; k++)
        CHECK(memcmp((const char *)first + k * stride, &copies[k], stride) == 0);
    CHECK(enmm_view_block_states(model, NULL, &stride, &count) == ENMM_NULL_ARGUMENT);
}

/* Samples with a friction each, together and one by one. */
static void check_rollout(enmm_model *model, uint32_t friction)
{
    double values[SAMPLES], out[SAMPLES][STEPS][OUTPUTS], alone[OUTPUTS];
    int32_t statuses[SAMPLES];
    const uint32_t ports[OUTPUTS] = {0, 0}, quantities[OUTPUTS] = {0, 1};
    enmm_state *state = NULL;
    enmm_rollout_plan plan;
    for (int k = 0; k < SAMPLES; k++)
        values[k] = 0.1 * k;
    OK(enmm_state_save(model, &state));
    memset(&plan, 0, sizeof plan);
    plan.struct_size = sizeof plan;
    plan.samples = SAMPLES;
    plan.states = &state;
    plan.state_count = 1;
    plan.parameters = &friction;
    plan.parameter_count = 1;
    plan.values = values;
    plan.step = 0.01;
    plan.steps = STEPS;
    plan.ports = ports;
    plan.quantities = quantities;
    plan.output_count = OUTPUTS;
    plan.threads = 2;
    OK(enmm_rollout(model, &plan, &out[0][0][0], SAMPLES * STEPS * OUTPUTS, statuses));
    for (int k = 0; k < SAMPLES; k++) {
        CHECK(statuses[k] == ENMM_OK);
        OK(enmm_state_restore(model, state));
        OK(enmm_set_parameter(model, friction, values[k]));
        moved(model, STEPS, alone);
        CHECK(memcmp(alone, out[k][STEPS - 1], sizeof alone) == 0);
    }
    OK(enmm_state_restore(model, state));
    CHECK(enmm_rollout(model, &plan, &out[0][0][0], 3, statuses) == ENMM_BUFFER_TOO_SMALL);
    plan.threads = 0;
    CHECK(enmm_rollout(model, &plan, &out[0][0][0], SAMPLES * STEPS * OUTPUTS, NULL) == ENMM_INVALID_ARGUMENT);
    plan.struct_size = 7;
    CHECK(enmm_rollout(model, &plan, &out[0][0][0], SAMPLES * STEPS * OUTPUTS, NULL) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_rollout(model, NULL, &out[0][0][0], 0, NULL) == ENMM_NULL_ARGUMENT);
    OK(enmm_state_restore_with(model, state, ENMM_KEEP_PARAMETERS));
    CHECK(enmm_state_restore_with(model, state, 8) == ENMM_INVALID_ARGUMENT);
    OK(enmm_state_free(state));
}

static void check_batch(const char *path)
{
    enmm_model *models[3];
    int32_t statuses[3];
    double together[OUTPUTS], alone[OUTPUTS];
    enmm_model *single = create(path);
    moved(single, 1, alone);
    for (int k = 0; k < 3; k++)
        models[k] = create(path);
    OK(enmm_batch_step(models, 3, 0.01, 2, statuses));
    CHECK(statuses[0] == 0 && statuses[1] == 0 && statuses[2] == 0);
    moved(models[2], 0, together);
    CHECK(memcmp(alone, together, sizeof alone) == 0);
    enmm_destroy(models[1]);
    CHECK(enmm_batch_step(models, 3, 0.01, 2, statuses) == ENMM_DEAD_HANDLE);
    CHECK(statuses[0] == 0 && statuses[1] == ENMM_DEAD_HANDLE && statuses[2] == 0);
    CHECK(enmm_batch_step(models, 3, 0.01, 0, NULL) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_batch_step(NULL, 3, 0.01, 1, NULL) == ENMM_NULL_ARGUMENT);
    enmm_destroy(models[0]);
    enmm_destroy(models[2]);
    enmm_destroy(single);
}

int main(int count, char **words)
{
    enmm_model *model = create(words[count - 1]);
    uint32_t friction = 0;
    OK(enmm_find_parameter(model, "joint_law.joint.friction", &friction));
    check_parameters(model, friction);
    check_inputs(model);
    check_view(model);
    check_rollout(model, friction);
    enmm_destroy(model);
    check_batch(words[count - 1]);
    return CHECKS_RESULT;
}
