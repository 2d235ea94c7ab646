/* Every function once as it should be used and once as it should not. Argument: a case file like tests/cases/small.toml. */
#include <math.h>
#include <stdlib.h>

#include "check.h"

enum { BLOCK, BASE, COUNT };

static enmm_model *create(const char *path)
{
    enmm_model *model = NULL;
    OK(enmm_create_from_file(path, &model));
    CHECK(model != NULL);
    return model;
}

static void creation(const char *path)
{
    enmm_model *model = (enmm_model *)&model;
    CHECK(enmm_create_from_file("/nowhere/at/all.toml", &model) == ENMM_FILE_ERROR);
    CHECK(model == NULL);
    CHECK(strstr(enmm_last_error(), "/nowhere/at/all.toml") != NULL);
    CHECK(enmm_create_from_string("[domain]\noutlin = []\n", NULL, &model) == ENMM_INVALID_CASE);
    CHECK(strstr(enmm_last_error(), "case:2") != NULL);
    CHECK(enmm_create_from_string("\xff", ".", &model) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_create_from_string(NULL, ".", &model) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_check_case("[domain]\noutlin = []\n", NULL) == ENMM_INVALID_CASE);
    CHECK(strstr(enmm_last_error(), "case:2") != NULL);
    CHECK(enmm_check_case("\xff", ".") == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_check_case(NULL, ".") == ENMM_NULL_ARGUMENT);
    CHECK(enmm_create_from_file(NULL, &model) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_create_from_file(path, NULL) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_abi_version() == ENMM_ABI_VERSION);
    CHECK(strlen(enmm_version()) >= 5);
}

static void dead_handles(const char *path)
{
    enmm_model *model = create(path);
    enmm_model *old = model;
    enmm_state *state = NULL;
    double time = 0;
    char made_up[64] = {0};
    OK(enmm_state_save(model, &state));
    CHECK(enmm_get_time((enmm_model *)state, &time) == ENMM_DEAD_HANDLE);
    CHECK(enmm_state_free((enmm_state *)model) == ENMM_DEAD_HANDLE);
    enmm_destroy(model);
    enmm_destroy(model);
    enmm_destroy(NULL);
    CHECK(enmm_get_time(model, &time) == ENMM_DEAD_HANDLE);
    CHECK(strstr(enmm_last_error(), "dead") != NULL);
    CHECK(enmm_get_time(NULL, &time) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_get_time((enmm_model *)made_up, &time) == ENMM_DEAD_HANDLE);
    CHECK(enmm_do_step(model, 0, 0.01, NULL) == ENMM_DEAD_HANDLE);
    model = create(path);
    CHECK(model != old);
    CHECK(enmm_get_time(old, &time) == ENMM_DEAD_HANDLE);
    OK(enmm_state_restore(model, state));
    OK(enmm_state_free(state));
    CHECK(enmm_state_free(state) == ENMM_DEAD_HANDLE);
    CHECK(enmm_state_restore(model, state) == ENMM_DEAD_HANDLE);
    CHECK(enmm_state_restore(model, NULL) == ENMM_NULL_ARGUMENT);
    state = (enmm_state *)made_up;
    CHECK(enmm_state_save(NULL, &state) == ENMM_NULL_ARGUMENT && state == NULL);
    state = (enmm_state *)made_up;
    CHECK(enmm_state_deserialize(old, (const uint8_t *)"abc", 3, &state) == ENMM_DEAD_HANDLE && state == NULL);
    CHECK(enmm_state_save(model, NULL) == ENMM_NULL_ARGUMENT);
    OK(enmm_state_free(NULL));
    enmm_destroy(model);
}

static void inputs(enmm_model *model)
{
    const uint32_t ids[] = {BASE, BLOCK};
    const uint32_t wrong[] = {BLOCK, COUNT};
    const double none[] = {0, 0}, some[] = {1, 2}, bad[] = {0, NAN};
    OK(enmm_set_gravity(model, 0, -9.81));
    CHECK(enmm_set_gravity(model, 0, NAN) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_gravity(model, INFINITY, 0) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_block_force(model, BLOCK, 1, 2, 3));
    CHECK(enmm_set_block_force(model, COUNT, 1, 2, 3) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_block_force(model, BLOCK, 1, 2e15, 3) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_block_force(model, BLOCK, 1e15, 1, 1));
    OK(enmm_set_block_forces(model, ids, 2, some, some, some));
    CHECK(enmm_set_block_forces(model, wrong, 2, some, some, some) == ENMM_INVALID_ARGUMENT);
    CHECK(strstr(enmm_last_error(), "block") != NULL);
    CHECK(enmm_set_block_forces(model, ids, 2, some, some, bad) == ENMM_INVALID_ARGUMENT);
    CHECK(strstr(enmm_last_error(), "NaN") != NULL);
    CHECK(enmm_set_block_forces(model, ids, 2, NULL, some, some) == ENMM_NULL_ARGUMENT);
    OK(enmm_set_block_forces(model, NULL, 0, NULL, NULL, NULL));
    OK(enmm_set_block_forces(model, ids, 2, none, none, none));
    OK(enmm_set_base_acceleration(model, 0, 0));
    CHECK(enmm_set_base_acceleration(model, 1e5, 0) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_water_level(model, 0.25));
    CHECK(enmm_set_water_level(model, NAN) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_strength_factor(model, 1));
    CHECK(enmm_set_strength_factor(model, -1) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_interpolation(model, ENMM_INTERPOLATION_LINEAR));
    CHECK(enmm_set_interpolation(model, 2) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_interpolation(model, ENMM_INTERPOLATION_HOLD));
    OK(enmm_set_threads(model, 2));
    CHECK(enmm_set_threads(model, 0) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_threads(model, 1));
    CHECK(enmm_set_gravity(NULL, 0, 0) == ENMM_NULL_ARGUMENT);
}

static void ports(enmm_model *model)
{
    static const char *names[] = {"block", "side", "bed"};
    enmm_port_state state;
    enmm_port_type kind;
    uint32_t port, block;
    size_t count = 0, written = 0;
    char name[8];
    OK(enmm_port_count(model, &count));
    CHECK(count == 3);
    for (uint32_t k = 0; k < 3; k++) {
        OK(enmm_find_port(model, names[k], &port));
        CHECK(port == k);
        OK(enmm_port_name(model, k, NULL, 0, &written));
        CHECK(written == strlen(names[k]) + 1);
        OK(enmm_port_name(model, k, name, sizeof name, &written));
        CHECK(strcmp(name, names[k]) == 0);
        CHECK(enmm_port_name(model, k, name, 1, &written) == ENMM_BUFFER_TOO_SMALL);
        OK(enmm_port_kind(model, k, &kind));
        CHECK(kind == (enmm_port_type)k);
        OK(enmm_port_block(model, k, &block));
        memset(&state, 0x55, sizeof state);
        state.struct_size = sizeof state;
        OK(enmm_get_port_state(model, k, &state));
        CHECK(isfinite(state.displacement_x) && isfinite(state.slip));
    }
    CHECK(enmm_find_port(model, "absent", &port) == ENMM_NOT_FOUND);
    CHECK(strstr(enmm_last_error(), "side") != NULL);
    CHECK(enmm_port_kind(model, 3, &kind) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_get_port_state(model, 3, &state) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_boundary_traction(model, 1, 0, 0));
    CHECK(enmm_set_boundary_traction(model, 0, 0, 0) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_boundary_traction(model, 7, 0, 0) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_boundary_pressure(model, 1, 0));
    CHECK(enmm_set_boundary_pressure(model, 2, 0) == ENMM_INVALID_ARGUMENT);
    OK(enmm_set_joint_pressure(model, 2, 0));
    CHECK(enmm_set_joint_pressure(model, 1, 0) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_set_joint_pressure(model, 2, NAN) == ENMM_INVALID_ARGUMENT);
}

static void names(enmm_model *model)
{
    static const char *first[] = {"joint[0]", "joint", "rock", "settle", "block 0", "corner", "block"};
    static const size_t counts[] = {1, 1, 1, 2, COUNT, 1, 3};
    enmm_monitor_state corner;
    size_t count = 0, written = 0;
    char name[16];
    for (int32_t kind = ENMM_NAME_JOINT; kind <= ENMM_NAME_PORT; kind++) {
        OK(enmm_name_count(model, kind, &count));
        CHECK(count == counts[kind]);
        OK(enmm_name(model, kind, 0, NULL, 0, &written));
        CHECK(written == strlen(first[kind]) + 1);
        OK(enmm_name(model, kind, 0, name, sizeof name, &written));
        CHECK(strcmp(name, first[kind]) == 0);
        CHECK(enmm_name(model, kind, 0, name, 2, &written) == ENMM_BUFFER_TOO_SMALL);
        CHECK(enmm_name(model, kind, (uint32_t)count, name, sizeof name, &written) == ENMM_INVALID_ARGUMENT);
        CHECK(strstr(enmm_last_error(), "less than the number of") != NULL);
    }
    CHECK(enmm_name_count(model, 11, &count) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_name(model, -1, 0, name, sizeof name, &written) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_name_count(model, ENMM_NAME_LAW, NULL) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_name_count(NULL, ENMM_NAME_LAW, &count) == ENMM_NULL_ARGUMENT);
    memset(&corner, 0x55, sizeof corner);
    CHECK(enmm_get_monitor_state(model, 0, &corner) == ENMM_INVALID_ARGUMENT);
    corner.struct_size = sizeof corner;
    OK(enmm_get_monitor_state(model, 0, &corner));
    CHECK(corner.displacement_y < 0 && corner.displacement_y > -1e-3 && fabs(corner.velocity_x) < 1);
    CHECK(enmm_get_monitor_state(model, 1, &corner) == ENMM_INVALID_ARGUMENT);
}

/* The message stands at one address, which holds whatever is evaluated first. */
static void messages(enmm_model *model)
{
    const char *address = enmm_last_error();
    char *name = malloc(9001);
    uint32_t port;
    CHECK(enmm_set_gravity(model, NAN, 0) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_last_error() == address && strncmp(address, "gravity, x", 10) == 0);
    memset(name, 'x', 9000);
    name[9000] = 0;
    CHECK(enmm_find_port(model, name, &port) == ENMM_NOT_FOUND);
    CHECK(enmm_last_error() == address && strlen(address) == 4095 && strcmp(address + 4092, "...") == 0);
    free(name);
    CHECK(strcmp(enmm_status_name(ENMM_OK), "ENMM_OK") == 0);
    CHECK(strcmp(enmm_status_name(ENMM_WRONG_STATE), "ENMM_WRONG_STATE") == 0);
    CHECK(strcmp(enmm_status_name(-1), "unknown status") == 0);
}

static void steps(enmm_model *model)
{
    enmm_step_info info = {0};
    enmm_start_info found = {0};
    double time = -1, step = 0, communication = 0, stop = 0;
    CHECK(enmm_do_step(model, 0, 0.01, &info) == ENMM_INVALID_ARGUMENT);
    OK(enmm_get_time(model, &time));
    CHECK(time == 0);
    info.struct_size = sizeof info;
    CHECK(enmm_get_start_info(model, &found) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_get_start_info(model, NULL) == ENMM_NULL_ARGUMENT);
    found.struct_size = sizeof found;
    OK(enmm_get_start_info(model, &found));
    CHECK(found.started == 0 && found.settled == 0 && found.steps == 0);
    OK(enmm_start(model));
    OK(enmm_start(model));
    OK(enmm_get_start_info(model, &found));
    CHECK(found.started == 1 && found.settled == 1 && found.failed == 0 && found.steps > 10 && found.unbalanced == 0);
    OK(enmm_do_step(model, 0, 0.01, &info));
    CHECK(info.time == 0.01 && info.steps >= 10 && info.struct_size == sizeof info);
    OK(enmm_get_internal_step(model, &step));
    CHECK(fabs(step * (double)info.steps - 0.01) < 1e-12 && info.dt <= step * (1 + 1e-12));
    CHECK(enmm_do_step(model, 0, 0.01, &info) == ENMM_WRONG_TIME);
    CHECK(enmm_do_step(model, 0.01, -1, &info) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_do_step(model, 0.01, NAN, &info) == ENMM_INVALID_ARGUMENT);
    OK(enmm_do_step(model, 0.01, 0.01, NULL));
    OK(enmm_get_time(model, &time));
    CHECK(fabs(time - 0.02) < 1e-15);
    OK(enmm_get_communication_step(model, &communication));
    OK(enmm_get_stop_time(model, &stop));
    CHECK(communication == 0.01 && stop == 1.0);
    CHECK(enmm_get_time(model, NULL) == ENMM_NULL_ARGUMENT);
}

static void blocks(enmm_model *model)
{
    enmm_block_state states[COUNT];
    size_t count = 0, written = 99;
    memset(states, 0x55, sizeof states);
    states[0].struct_size = sizeof states[0];
    OK(enmm_block_count(model, &count));
    CHECK(count == COUNT);
    OK(enmm_get_block_states(model, NULL, 0, &written));
    CHECK(written == COUNT);
    written = 99;
    CHECK(enmm_get_block_states(model, states, 1, &written) == ENMM_BUFFER_TOO_SMALL);
    CHECK(written == COUNT && states[0].id == 0x55555555u);
    CHECK(enmm_get_block_states(model, NULL, 1, &written) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_get_block_states(model, states, COUNT, NULL) == ENMM_NULL_ARGUMENT);
    OK(enmm_get_block_states(model, states, COUNT, &written));
    for (uint32_t k = 0; k < COUNT; k++)
        CHECK(states[k].id == k && states[k].struct_size == sizeof states[k]);
    CHECK(states[BASE].flags == ENMM_BLOCK_FIXED && states[BLOCK].flags == 0);
    CHECK(fabs(states[BLOCK].area - 1) < 1e-9 && fabs(states[BLOCK].mass - 2500) < 1e-6);
    CHECK(fabs(states[BASE].area - 3.88) < 1e-9);
    CHECK(fabs(states[BLOCK].centroid_x - 0.5) < 1e-3 && fabs(states[BLOCK].centroid_y - 0.5) < 1e-3);
    CHECK(states[BLOCK].contacts > 0 && states[BLOCK].mean_stress_yy < 0);
    CHECK(states[BLOCK].contact_count == states[BLOCK].contacts);
    CHECK(&states[BLOCK].largest_penetration == &states[BLOCK].penetration_max);
    states[0].struct_size = sizeof states[0] - 16;
    CHECK(enmm_get_block_states(model, states, COUNT, &written) == ENMM_INVALID_ARGUMENT);
}

static void shapes(enmm_model *model)
{
    double xy[64], area = 0;
    size_t n = 0, written = 0;
    uint32_t block = 99;
    OK(enmm_get_block_polygon(model, BLOCK, NULL, 0, &n));
    CHECK(n >= 4 && n <= 32);
    CHECK(enmm_get_block_polygon(model, BLOCK, xy, n - 1, &written) == ENMM_BUFFER_TOO_SMALL);
    CHECK(written == n);
    OK(enmm_get_block_polygon(model, BLOCK, xy, 32, &written));
    for (size_t k = 0; k < n; k++) {
        size_t next = (k + 1) % n;
        area += 0.5 * (xy[2 * k] * xy[2 * next + 1] - xy[2 * next] * xy[2 * k + 1]);
    }
    CHECK(fabs(area - 1) < 1e-3);
    CHECK(enmm_get_block_polygon(model, COUNT, xy, 32, &written) == ENMM_INVALID_ARGUMENT);
    OK(enmm_block_hole_count(model, BASE, &n));
    CHECK(n == 1);
    OK(enmm_get_block_hole(model, BASE, 0, xy, 32, &written));
    CHECK(written >= 4 && written <= 32);
    CHECK(enmm_get_block_hole(model, BASE, 1, xy, 32, &written) == ENMM_INVALID_ARGUMENT);
    OK(enmm_find_block_at(model, 0.5, 0.5, &block));
    CHECK(block == BLOCK);
    OK(enmm_find_block_at(model, -0.5, -0.5, &block));
    CHECK(block == BASE);
    CHECK(enmm_find_block_at(model, 2.2, -0.5, &block) == ENMM_NOT_FOUND);
    CHECK(enmm_find_block_at(model, 2.2, 0.5, &block) == ENMM_NOT_FOUND);
    CHECK(enmm_find_block_at(model, NAN, 0.5, &block) == ENMM_INVALID_ARGUMENT);
}

static void sums(enmm_model *model)
{
    enmm_energies energies = {0};
    enmm_totals totals = {0};
    enmm_contact contacts[64];
    enmm_event event;
    size_t written = 0;
    double force = 0;
    char hash[17];
    CHECK(enmm_get_energies(model, &energies) == ENMM_INVALID_ARGUMENT);
    energies.struct_size = sizeof energies;
    OK(enmm_get_energies(model, &energies));
    CHECK(energies.strain > 0 && fabs(energies.residual) < 1e-2 * fabs(energies.potential));
    totals.struct_size = sizeof totals;
    OK(enmm_get_totals(model, &totals));
    CHECK(totals.critical_dt > 0 && totals.slipping_contacts + totals.locked_contacts > 0);
    contacts[0].struct_size = sizeof contacts[0];
    OK(enmm_get_contacts(model, contacts, 64, &written));
    for (size_t k = 0; k < written; k++) {
        CHECK(contacts[k].node_block < COUNT && contacts[k].edge_block < COUNT);
        if (fabs(contacts[k].normal_y) > 0.9)
            force -= contacts[k].normal_stress * contacts[k].length;
    }
    CHECK(force > 0.7 * 2500 * 9.81 && force < 1.1 * 2500 * 9.81);
    OK(enmm_get_events(model, 0, NULL, 0, &written));
    OK(enmm_get_events(model, 1000, &event, 0, &written));
    CHECK(written == 0);
    OK(enmm_case_hash(model, hash, sizeof hash, &written));
    CHECK(written == 17 && strlen(hash) == 16);
}

struct host_log {
    int messages, errors;
    enmm_model *model;
};

static void on_log(void *user, enmm_log_level level, const char *message)
{
    struct host_log *log = user;
    double time;
    log->messages++;
    log->errors += level == ENMM_LOG_ERROR;
    CHECK(message[0] != 0);
    OK(enmm_get_time(log->model, &time)); /* the model is free when it speaks */
}

/* Pushes the block away: events come, in the step info, in the log and in the list; going back takes them back. */
static void events_and_states(enmm_model *model)
{
    struct host_log log = {0, 0, model};
    enmm_step_info info = {sizeof info, 0, 0, 0, 0, 0, 0, 0};
    enmm_block_state before[COUNT], after[COUNT];
    enmm_event events[16];
    enmm_state *state = NULL, *copy = NULL;
    unsigned char *bytes;
    size_t size = 0, written = 0, seen = 0, first = 0;
    double time = 0;
    enmm_state *none = (enmm_state *)&none;
    before[0].struct_size = after[0].struct_size = sizeof before[0];
    OK(enmm_set_log_callback(model, on_log, &log));
    OK(enmm_get_time(model, &time));
    OK(enmm_state_save(model, &state));
    OK(enmm_state_serialize(model, state, NULL, 0, &size));
    bytes = malloc(size);
    CHECK(enmm_state_serialize(model, state, bytes, size - 1, &written) == ENMM_BUFFER_TOO_SMALL);
    OK(enmm_state_serialize(model, state, bytes, size, &written));
    CHECK(written == size);
    OK(enmm_set_gravity(model, 20, -9.81));
    OK(enmm_get_events(model, 0, NULL, 0, &first));
    for (int k = 0; k < 20; k++) {
        OK(enmm_do_step(model, time + 0.01 * k, 0.01, &info));
        CHECK(info.first_event == first + seen);
        seen += info.event_count;
    }
    CHECK(seen >= 2 && log.messages >= (int)seen && log.errors == 0);
    events[0].struct_size = sizeof events[0];
    OK(enmm_get_events(model, first, events, 16, &written));
    CHECK(written == seen && events[0].kind == ENMM_EVENT_SLIPPED && events[0].time > time);
    OK(enmm_get_block_states(model, before, COUNT, &written));
    CHECK((before[BLOCK].flags & ENMM_BLOCK_FAILED) && before[BLOCK].displacement_x > 0.1);
    OK(enmm_state_deserialize(model, bytes, size, &copy));
    OK(enmm_state_restore(model, copy));
    OK(enmm_get_events(model, 0, NULL, 0, &written));
    CHECK(written == first);
    OK(enmm_set_gravity(model, 20, -9.81));
    for (int k = 0; k < 20; k++)
        OK(enmm_do_step(model, time + 0.01 * k, 0.01, NULL));
    OK(enmm_get_block_states(model, after, COUNT, &written));
    CHECK(memcmp(before, after, sizeof after) == 0);
    CHECK(enmm_do_step(model, 7, 0.01, NULL) == ENMM_WRONG_TIME);
    CHECK(log.errors == 1);
    OK(enmm_set_log_callback(model, NULL, NULL));
    bytes[size / 2] ^= 1;
    CHECK(enmm_state_deserialize(model, bytes, size, &none) == ENMM_WRONG_STATE);
    CHECK(none == NULL);
    CHECK(enmm_state_deserialize(model, bytes, size / 3, &none) == ENMM_WRONG_STATE);
    CHECK(enmm_state_deserialize(model, NULL, 0, &none) == ENMM_WRONG_STATE);
    CHECK(enmm_state_deserialize(model, NULL, 4, &none) == ENMM_NULL_ARGUMENT);
    OK(enmm_state_free(copy));
    OK(enmm_state_free(state));
    free(bytes);
}

/* A step that fails leaves the model at its place, and the next one goes well. */
static void failures(enmm_model *model)
{
    enmm_block_state before[COUNT], after[COUNT];
    enmm_step_info info = {sizeof info, 0, 0, 0, 0, 0, 0, 0};
    enmm_step_info same = info;
    size_t written;
    double time = 0, now = 0;
    before[0].struct_size = after[0].struct_size = sizeof before[0];
    OK(enmm_get_time(model, &time));
    OK(enmm_get_block_states(model, before, COUNT, &written));
    OK(enmm_set_gravity(model, 1e4, 0));
    CHECK(enmm_do_step(model, time, 1, &info) == ENMM_NUMERICAL_FAILURE);
    CHECK(memcmp(&info, &same, sizeof info) == 0);
    CHECK(strstr(enmm_last_error(), "block 0") != NULL);
    OK(enmm_get_time(model, &now));
    OK(enmm_get_block_states(model, after, COUNT, &written));
    CHECK(now == time && memcmp(before, after, sizeof after) == 0);
    OK(enmm_set_gravity(model, 0, -9.81));
    OK(enmm_do_step(model, time, 0.01, &info));
}

static void other_cases(enmm_model *model)
{
    static const char *other_case =
        "title = \"t\"\n[domain]\noutline = [[0, 0], [1, 0], [1, 1], [0, 1]]\n[mesh]\nsize = 0.5\norigin = [0.03, 0.02]\n"
        "[rock.rock]\ndensity = 2500\nyoung = 1e9\npoisson = 0.25\n[[stage]]\nname = \"free\"\nkind = \"dynamic\"\nduration = 1\n";
    enmm_model *other = NULL;
    enmm_state *state = NULL;
    size_t size;
    OK(enmm_check_case(other_case, NULL));
    OK(enmm_create_from_string(other_case, NULL, &other));
    OK(enmm_state_save(other, &state));
    CHECK(enmm_state_restore(model, state) == ENMM_WRONG_STATE);
    CHECK(strstr(enmm_last_error(), "is of case") != NULL);
    CHECK(enmm_state_serialize(model, state, NULL, 0, &size) == ENMM_WRONG_STATE);
    CHECK(enmm_set_water_level(other, 1) == ENMM_INVALID_ARGUMENT);
    enmm_destroy(other);
    OK(enmm_state_free(state));
}

struct warnings {
    int overlaps, others;
};

/* Recording that cannot be: without a folder, without a recording, of no model. */
static void no_records(enmm_model *model)
{
    CHECK(enmm_record(model, NULL) == ENMM_NULL_ARGUMENT);
    CHECK(enmm_record(model, "") == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_write_frame(model) == ENMM_INVALID_ARGUMENT && enmm_end_record(model) == ENMM_INVALID_ARGUMENT);
    CHECK(enmm_record(NULL, "folder") == ENMM_NULL_ARGUMENT && enmm_write_frame(NULL) == ENMM_NULL_ARGUMENT);
}

static void on_warning(void *user, enmm_log_level level, const char *message)
{
    struct warnings *warnings = user;
    if (level == ENMM_LOG_WARNING && strstr(message, "blocks 0 and 1 overlap by") && strstr(message, "% of the mesh size"))
        warnings->overlaps++;
    else
        warnings->others += level == ENMM_LOG_WARNING;
}

/* A block sinks into a soft joint: one event with both blocks and the depth, a warning, and two totals. */
static void overlaps(void)
{
    static const char *soft =
        "title = \"t\"\n[domain]\noutline = [[0, 0], [3, 0], [3, 1], [2, 1], [2, 2], [1, 2], [1, 1], [0, 1]]\n[mesh]\n"
        "size = 0.5\n[[joint]]\npoints = [[1, 1], [2, 1]]\n[rock.rock]\ndensity = 2650\nyoung = 5e9\npoisson = 0.25\n"
        "[joint_law.soft]\nfriction_deg = 30\nnormal_stiffness = 1.3e6\nshear_stiffness = 1.3e6\n[[fix]]\n"
        "edge = [[0, 0], [3, 0]]\n[[stage]]\nname = \"sink\"\nkind = \"dynamic\"\nduration = 0.2\n";
    struct warnings warnings = {0, 0};
    enmm_step_info info = {sizeof info, 0, 0, 0, 0, 0, 0, 0};
    enmm_totals totals;
    enmm_event events[8];
    size_t written = 0, found = 8, overlaps = 0;
    enmm_model *model = NULL;
    OK(enmm_create_from_string(soft, NULL, &model));
    OK(enmm_set_log_callback(model, on_warning, &warnings));
    OK(enmm_do_step(model, 0, 0.1, &info));
    events[0].struct_size = sizeof events[0];
    OK(enmm_get_events(model, 0, events, 8, &written));
    for (size_t k = 0; k < written; k++) {
        if (events[k].kind == ENMM_EVENT_OVERLAPPED) {
            found = k;
            overlaps++;
        } else {
            CHECK(events[k].other == ENMM_NO_BLOCK && events[k].depth == 0);
        }
    }
    CHECK(overlaps == 1 && info.event_count == written);
    if (overlaps == 1) {
        CHECK(events[found].subject == 0 && events[found].other == 1 && events[found].reserved == 0);
        CHECK(events[found].depth > 0.005 && events[found].time > 0.03 && events[found].time < 0.05);
    }
    totals.struct_size = sizeof totals;
    OK(enmm_get_totals(model, &totals));
    CHECK(totals.overlapping_pairs == 1 && totals.overlap_max > 0.01 && totals.overlap_max < 0.04);
    CHECK(warnings.overlaps == 1 && warnings.others == 0);
    enmm_destroy(model);
}

struct turncoat {
    enmm_model *model;
    struct turncoat *next; /* speaks in its place from the first message on; none: the model is destroyed */
    int messages, freed;
};

static void on_turn(void *user, enmm_log_level level, const char *message)
{
    struct turncoat *self = user;
    (void)level;
    CHECK(!self->freed && message[0] != 0);
    self->freed = 1; /* from here on the library must not know it any more */
    self->messages++;
    if (self->next != NULL)
        OK(enmm_set_log_callback(self->model, on_turn, self->next));
    else
        enmm_destroy(self->model);
}

/* Every message looks for the callback anew: one that replaced itself or destroyed the model gets no further one. */
static void turncoats(const char *path)
{
    enmm_model *model = create(path);
    struct turncoat second = {NULL, NULL, 0, 0}, first = {NULL, NULL, 0, 0};
    double time = 0;
    first.model = second.model = model;
    first.next = &second;
    OK(enmm_start(model));
    OK(enmm_get_time(model, &time));
    OK(enmm_set_gravity(model, 20, -9.81));
    OK(enmm_set_log_callback(model, on_turn, &first));
    for (int k = 0; k < 20 && second.messages == 0; k++)
        OK(enmm_do_step(model, time + 0.2 * k, 0.2, NULL));
    CHECK(first.messages == 1 && second.messages == 1);
    CHECK(enmm_get_time(model, &time) == ENMM_DEAD_HANDLE);
}

int main(int argc, char **argv)
{
    enmm_model *model;
    if (argc != 2)
        return 2;
    creation(argv[1]);
    dead_handles(argv[1]);
    model = create(argv[1]);
    inputs(model);
    ports(model);
    messages(model);
    steps(model);
    names(model);
    blocks(model);
    shapes(model);
    sums(model);
    events_and_states(model);
    failures(model);
    other_cases(model);
    no_records(model);
    enmm_destroy(model);
    turncoats(argv[1]);
    overlaps();
    return CHECKS_RESULT;
}
