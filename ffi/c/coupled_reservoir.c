/*
 * A reservoir fills in front of a jointed slope: two models that exchange values every communication step.
 *
 * The host owns the reservoir. Its volume (m3 per metre of width) grows by an inflow, and the level follows from it; rock
 * that the water pushes back makes room. The library owns the slope. The level goes into it; the motion of the wetted face
 * comes back. Halfway the host tries what twice the inflow would do, and goes back to the saved state.
 *
 *     cc -std=c99 -I include ffi/c/coupled_reservoir.c -L target/release -lenmm -lm -Wl,-rpath,target/release
 *     ./a.out examples/cases/coupled_slope.toml
 *
 * The exit status is 0 when everything went as it must.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "enmm.h"

#define STEPS 100

/* Everything that is exchanged. */
struct coupling {
    enmm_model *slope;
    uint32_t face, toe, plane;
    double h;           /* communication step (s) */
    double level;       /* height of the water (m) */
    double face_before; /* how far the face had moved away from the water (m) */
    int events;
};

static int wrong = 0;

static void must(int holds, const char *what)
{
    if (!holds) {
        wrong++;
        fprintf(stderr, "not so: %s\n", what);
    }
}

/* Ends the program when a call fails: nothing below makes sense without it. */
static void done(enmm_status status, const char *what)
{
    if (status != ENMM_OK) {
        fprintf(stderr, "%s: status %d: %s\n", what, (int)status, enmm_last_error());
        exit(1);
    }
}

static void on_message(void *user, enmm_log_level level, const char *message)
{
    struct coupling *coupling = user;
    static const char *const levels[] = {"error", "warning", "info"};
    coupling->events += level == ENMM_LOG_INFO;
    printf("  [%s] %s\n", levels[level], message);
}

static enmm_port_state port(const struct coupling *c, uint32_t number)
{
    enmm_port_state state = {0};
    state.struct_size = sizeof state;
    done(enmm_get_port_state(c->slope, number, &state), "state of a port");
    return state;
}

/* Width of the reservoir at the water line (m): the valley is wider above. */
static double width(double level)
{
    return 40.0 + 6.0 * level;
}

/* The level after `h` seconds of inflow (m2/s), by the rule of the midpoint; `room` (m2) is what the rock has made. */
static double rise(double level, double inflow, double room, double h)
{
    const double middle = level + 0.5 * h * inflow / width(level);
    return level + (h * inflow - room) / width(middle);
}

/* One communication step: the level at its end goes in, is reached linearly, and the motion of the face comes out. */
static void step(struct coupling *c, double time, double inflow)
{
    enmm_step_info info = {0};
    info.struct_size = sizeof info;
    const enmm_port_state face = port(c, c->face);
    /* The face dips by 57.5 degrees; the normal away from the water is (0.844, -0.537). */
    const double moved = 0.844 * face.displacement_x - 0.537 * face.displacement_y;
    const double wet = c->level > 8.0 ? (c->level - 8.0) / 0.844 : 0.0;
    c->level = rise(c->level, inflow, wet * (moved - c->face_before), c->h);
    c->face_before = moved;
    done(enmm_set_water_level(c->slope, c->level), "water level");
    done(enmm_do_step(c->slope, time, c->h, &info), "step");
    must(fabs(info.time - (time + c->h)) < 1e-12, "a step ends at t + h");
    must(info.unsettled == 0, "contact forces settle");
}

static void read_blocks(const struct coupling *c, enmm_block_state *states, size_t count)
{
    size_t written = 0;
    memset(states, 0, count * sizeof *states);
    states[0].struct_size = sizeof *states;
    done(enmm_get_block_states(c->slope, states, count, &written), "states of the blocks");
    must(written == count, "every block has a state");
}

/* Twice the inflow for ten steps, then back; the steps after it must not notice. */
static void what_if(struct coupling *c, double time, double inflow)
{
    const struct coupling before = *c;
    size_t count = 0;
    double now = -1;
    enmm_state *saved = NULL;
    done(enmm_block_count(c->slope, &count), "number of blocks");
    enmm_block_state *first = calloc(count, sizeof *first), *again = calloc(count, sizeof *again);
    done(enmm_state_save(c->slope, &saved), "save");
    step(c, time, inflow);
    read_blocks(c, first, count);
    for (int k = 1; k < 10; k++)
        step(c, time + k * c->h, 2 * inflow);
    printf("  with twice the inflow: level %.3f m after ten steps\n", c->level);
    *c = before;
    done(enmm_state_restore(c->slope, saved), "restore");
    done(enmm_get_time(c->slope, &now), "time");
    must(now == time, "a restored model is back at its time");
    step(c, time, inflow);
    read_blocks(c, again, count);
    must(memcmp(first, again, count * sizeof *first) == 0, "the same step gives the same bits");
    *c = before;
    done(enmm_state_restore(c->slope, saved), "restore");
    done(enmm_state_free(saved), "free");
    free(first);
    free(again);
}

static void print_row(const struct coupling *c, double time)
{
    enmm_totals totals = {0};
    totals.struct_size = sizeof totals;
    done(enmm_get_totals(c->slope, &totals), "totals");
    const enmm_port_state toe = port(c, c->toe), plane = port(c, c->plane);
    printf("%6.2f %8.4f %10.3f %10.3f %12.1f %12.1f %8u\n", time, c->level, 1e3 * toe.displacement_x,
           1e3 * toe.displacement_y, 1e-3 * plane.normal_force, 1e-3 * plane.shear_force, totals.slipping_contacts);
}

static void run(struct coupling *c)
{
    const double inflow = 600.0, begin = c->level;
    printf("  t, s  level, m  toe x, mm  toe y, mm  normal, kN/m  shear, kN/m  slipping\n");
    for (int k = 0; k < STEPS; k++) {
        const double before = c->level, time = k * c->h;
        if (k == STEPS / 2)
            what_if(c, time, inflow);
        step(c, time, inflow);
        must(c->level > before, "the level rises");
        if ((k + 1) % 10 == 0)
            print_row(c, (k + 1) * c->h);
    }
    must(c->level > begin + 4.0 && c->level < begin + 8.0, "the reservoir takes what flows in");
}

static void judge(const struct coupling *c)
{
    enmm_energies energies = {0};
    double time = 0;
    energies.struct_size = sizeof energies;
    done(enmm_get_time(c->slope, &time), "time");
    done(enmm_get_energies(c->slope, &energies), "energies");
    printf("energy that appeared from nowhere: %.3g of %.3g J/m\n", energies.residual, energies.external_work);
    must(fabs(time - STEPS * c->h) < 1e-9, "the model is where the host is");
    must(fabs(energies.residual) < 1e-2 * fabs(energies.external_work), "energy is kept");
    must(hypot(port(c, c->toe).displacement_x, port(c, c->toe).displacement_y) < 0.01, "the slope stands");
}

int main(int argc, char **argv)
{
    struct coupling c = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: %s examples/cases/coupled_slope.toml\n", argv[0]);
        return 2;
    }
    if (enmm_abi_version() != ENMM_ABI_VERSION) {
        fprintf(stderr, "the library has another binary interface than the header\n");
        return 2;
    }
    done(enmm_create_from_file(argv[1], &c.slope), "create");
    done(enmm_set_log_callback(c.slope, on_message, &c), "log");
    done(enmm_find_port(c.slope, "face", &c.face), "port");
    done(enmm_find_port(c.slope, "toe", &c.toe), "port");
    done(enmm_find_port(c.slope, "plane", &c.plane), "port");
    done(enmm_get_communication_step(c.slope, &c.h), "communication step");
    done(enmm_set_interpolation(c.slope, ENMM_INTERPOLATION_LINEAR), "interpolation");
    c.level = 6.0;
    done(enmm_set_water_level(c.slope, c.level), "water level");
    done(enmm_start(c.slope), "initial equilibrium");
    const enmm_port_state face = port(&c, c.face);
    c.face_before = 0.844 * face.displacement_x - 0.537 * face.displacement_y;
    run(&c);
    judge(&c);
    enmm_destroy(c.slope);
    enmm_destroy(c.slope); /* a dead handle is no danger */
    printf("%d checks failed\n", wrong);
    return wrong ? 1 : 0;
}
