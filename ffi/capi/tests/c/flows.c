/* Water that flows in the joint below a dam: heads, rain and a drain that a host sets, pressures and flows of hand
   calculations, and the same bits after a return and in another model, also where the flow goes on in time. Arguments:
   case files like tests/cases/dam.toml and tests/cases/draining_dam.toml. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "state_bytes.h"

static const double H = 1.0 / 256;
static const double WEIGHT = 9810;
static const double T = 9810 * 1e-12 / (12 * 1e-3);

static int near(double a, double b, double scale)
{
    return fabs(a - b) <= 1e-12 * scale;
}

static enmm_inlet_state inlet(enmm_model *model, int32_t kind, const char *name)
{
    enmm_inlet_state state = {.struct_size = sizeof state};
    uint32_t index = 99;
    OK(enmm_find_name(model, kind, name, &index));
    OK(enmm_get_inlet_state(model, kind, index, &state));
    return state;
}

static enmm_port_state base(enmm_model *model)
{
    enmm_port_state state = {.struct_size = sizeof state};
    uint32_t port = 99;
    OK(enmm_find_port(model, "base", &port));
    OK(enmm_get_port_state(model, port, &state));
    return state;
}

/* Heads above the joint at heel and toe. */
static void through(enmm_model *model, double heel, double toe)
{
    const double mean = WEIGHT * (heel + toe) / 2;
    const enmm_port_state port = base(model);
    CHECK(near(port.water_pressure, mean, mean));
    CHECK(near(port.water_pressure_max, WEIGHT * heel, WEIGHT * heel));
    CHECK(near(port.uplift, 20 * mean, 20 * mean));
    CHECK(near(inlet(model, ENMM_NAME_HEAD, "heel").inflow, T * (heel - toe) / 20, T));
    CHECK(near(inlet(model, ENMM_NAME_HEAD, "toe").outflow, T * (heel - toe) / 20, T));
}

static void act(enmm_model *model, int first, int last)
{
    for (int k = first; k < last; k++) {
        OK(enmm_set_head(model, 0, 9 - 0.1 * k));
        OK(enmm_set_drain(model, 0, k % 5 > 2));
        OK(enmm_set_rain(model, 0, 1e-9 * k));
        OK(enmm_do_step(model, k * H, H, NULL));
    }
}

static void refuse(enmm_model *model)
{
    enmm_inlet_state state = {.struct_size = sizeof state};
    uint32_t index = 7;
    double value = 7;
    CHECK(enmm_set_head(model, 2, 1) == ENMM_INVALID_ARGUMENT && strstr(enmm_last_error(), "number of heads, 2"));
    CHECK(enmm_set_head(model, 0, NAN) == ENMM_INVALID_ARGUMENT && strstr(enmm_last_error(), "head \"heel\""));
    CHECK(enmm_set_rain(model, 0, -1) == ENMM_INVALID_ARGUMENT && strstr(enmm_last_error(), "rain \"crest\""));
    CHECK(enmm_set_drain(model, 1, 1) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_head(NULL, 0, 1) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_find_name(model, ENMM_NAME_HEAD, "crest", &index) == ENMM_NOT_FOUND && index == 7);
    CHECK(strstr(enmm_last_error(), "heel, toe"));
    CHECK(enmm_find_name(model, 11, "heel", &index) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_find_name(model, ENMM_NAME_HEAD, NULL, &index) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_find_name(model, ENMM_NAME_HEAD, "toe", NULL) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_get_inlet_state(model, ENMM_NAME_PORT, 0, &state) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_get_inlet_state(model, ENMM_NAME_RAIN, 1, &state) == ENMM_INVALID_ARGUMENT);
    state.struct_size = 8;
    CHECK(enmm_get_inlet_state(model, ENMM_NAME_RAIN, 0, &state) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_get_inlet_input(model, ENMM_NAME_JOINT, 0, &value) == ENMM_INVALID_ARGUMENT && value == 7);
    CHECK(enmm_set_input_interpolation(model, ENMM_INPUT_HEAD, 2, 1) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_input_interpolation(model, 9, 0, 1) == ENMM_INVALID_ARGUMENT);
}

/* Flow that goes on in time: the joints hold what has entered and not left, and the bits are the same again. */
static void drain(const char *file)
{
    enmm_model *model = NULL;
    enmm_state *saved = NULL;
    enmm_totals totals = {.struct_size = sizeof totals};
    size_t end_size;
    OK(enmm_create_from_file(file, &model));
    OK(enmm_start(model));
    through(model, 6, 1);
    OK(enmm_state_save(model, &saved));
    act(model, 0, 5);
    OK(enmm_get_totals(model, &totals));
    const double passed = totals.water_entered + totals.water_left;
    const double open = totals.water_entered - totals.water_left - totals.water_stored;
    CHECK(totals.water_entered > 0 && totals.water_left > 0 && fabs(totals.water_stored) > 1e-6 * passed);
    CHECK(fabs(open) <= 1e-12 * passed + 1e-15);
    unsigned char *at_end = bytes_of(model, &end_size);
    OK(enmm_state_restore(model, saved));
    OK(enmm_get_totals(model, &totals));
    CHECK(totals.water_entered == 0 && totals.water_stored == 0);
    act(model, 0, 5);
    check_bytes(model, at_end, end_size);
    free(at_end);
    OK(enmm_state_free(saved));
    enmm_destroy(model);
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    drain(argv[2]);
    enmm_model *model = NULL, *other = NULL;
    enmm_state *saved = NULL, *read = NULL;
    enmm_totals totals = {.struct_size = sizeof totals};
    size_t half_size, end_size, count = 0;
    double value = 0;
    OK(enmm_create_from_file(argv[1], &model));
    OK(enmm_name_count(model, ENMM_NAME_DRAIN, &count));
    CHECK(count == 1);
    refuse(model);
    OK(enmm_start(model));
    through(model, 6, 1);
    OK(enmm_set_input_interpolation(model, ENMM_INPUT_RAIN, 0, ENMM_INTERPOLATION_HOLD));
    OK(enmm_set_head(model, 1, 5));
    OK(enmm_get_inlet_input(model, ENMM_NAME_HEAD, 1, &value));
    CHECK(value == 5);
    OK(enmm_get_inlet_input(model, ENMM_NAME_DRAIN, 0, &value));
    CHECK(value == 0);
    OK(enmm_do_step(model, 0, H, NULL));
    through(model, 6, 2);
    act(model, 1, 4);
    OK(enmm_get_totals(model, &totals));
    CHECK(totals.water_entered > 0 && near(totals.water_entered, totals.water_left, totals.water_entered));
    CHECK(totals.flow_residual <= 1e-12 * T && totals.seepage_height == 3);

    OK(enmm_state_save(model, &saved));
    unsigned char *at_half = bytes_of(model, &half_size);
    act(model, 4, 9);
    unsigned char *at_end = bytes_of(model, &end_size);
    CHECK(inlet(model, ENMM_NAME_DRAIN, "row").outflow > 0);
    CHECK(near(inlet(model, ENMM_NAME_RAIN, "crest").inflow, 8e-9 * 20, T));

    OK(enmm_state_restore(model, saved));
    check_bytes(model, at_half, half_size);
    act(model, 4, 9);
    check_bytes(model, at_end, end_size);

    OK(enmm_create_from_file(argv[1], &other));
    OK(enmm_state_deserialize(other, at_half, half_size, &read));
    OK(enmm_state_restore(other, read));
    act(other, 4, 9);
    check_bytes(other, at_end, end_size);

    OK(enmm_state_free(saved));
    OK(enmm_state_free(read));
    free(at_half);
    free(at_end);
    enmm_destroy(model);
    enmm_destroy(other);
    return CHECKS_RESULT;
}
