/*
 * A slope is shaken harder and harder until a block fails; the host then goes back to the last state before and asks how
 * much support would have held it.
 *
 *     c++ -std=c++17 -I include -I ffi/cpp ffi/cpp/example.cpp -L target/release -lenmm -Wl,-rpath,target/release
 *     ./a.out ffi/capi/tests/cases/small.toml
 *
 * The case needs a port of a block called "block". The exit status is 0 when everything went as it must.
 */
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "enmm.hpp"

namespace {

int wrong = 0;

struct LooksBad {};

void must(bool holds, const char *what)
{
    if (!holds) {
        ++wrong;
        std::fprintf(stderr, "not so: %s\n", what);
    }
}

/** Runs for a while under base acceleration and the support force; tells whether the block stays. */
bool holds(enmm::Model &model, const enmm::State &from, std::uint32_t block, double acceleration, double support)
{
    model.restore(from);
    model.set_base_acceleration({acceleration, 0});
    model.set_block_force(block, {support, 0});
    const double begin = model.time(), h = model.communication_step();
    for (int k = 0; k < 30; ++k)
        model.do_step(begin + k * h, h);
    return (model.block_states().at(block).flags & ENMM_BLOCK_FAILED) == 0;
}

/** A function that sees a step of years ends it; the model is where it was. */
void calls_can_be_stopped(enmm::Model &model)
{
    const double before = model.time();
    int looks = 0;
    model.set_progress([&](const enmm::Progress &progress) {
        must(progress.time < progress.end, "a call in progress has not come to its end");
        return ++looks < 3;
    });
    try {
        model.do_step(before, 1e8);
        must(false, "a step that was stopped throws");
    } catch (const enmm::Error &error) {
        must(error.status() == ENMM_INTERRUPTED && looks == 3, "the third look ends the step");
    }
    model.set_progress([](const enmm::Progress &) -> bool { throw LooksBad(); });
    try {
        model.do_step(before, 1e8);
        must(false, "what a look throws comes out of the step");
    } catch (const LooksBad &) {
    }
    model.set_progress({});
    must(model.time() == before, "a step that was stopped moves nothing");
}

void errors_are_exceptions(enmm::Model &model)
{
    try {
        model.set_gravity({NAN, 0});
        must(false, "a value that is no number throws");
    } catch (const enmm::Error &error) {
        must(error.status() == ENMM_INVALID_ARGUMENT, "the exception tells the status");
        std::printf("as it should be: %s\n", error.what());
    }
    try {
        enmm::Model::from_file("absent.toml");
        must(false, "a file that is absent throws");
    } catch (const enmm::Error &error) {
        must(error.status() == ENMM_FILE_ERROR, "the exception tells the status");
    }
}

/** The block with friction of its own in each sample, and the same call by call. */
void samples_are_as_single_calls(enmm::Model &model, const enmm::State &from, std::uint32_t port)
{
    const std::string friction = "joint_law.joint.friction";
    const double h = model.communication_step();
    enmm::Rollout plan;
    plan.samples = 3;
    plan.states = {&from};
    plan.parameters = {friction};
    plan.values = {0.2, 0.4, 0.6};
    plan.step = h;
    plan.steps = 5;
    plan.outputs = {{port, 0}};
    plan.threads = 2;
    const auto made = model.roll_out(plan);
    model.restore(from);
    const double before = model.parameter(friction);
    model.set_parameters({{friction, plan.values[1]}});
    for (std::size_t k = 0; k < plan.steps; ++k) {
        enmm::batch_step({&model}, h);
        must(model.port_state(port).displacement_x == made.values.at(plan.steps + k), "a sample has the bits of calls");
    }
    must(made.statuses == std::vector<enmm_status>(3, ENMM_OK), "no sample fails");
    must(model.view_block_states()[0].centroid_x == model.block_states()[0].centroid_x, "a view is the copy");
    must(model.parameter_range(model.find_parameter(friction)).is_tunable, "friction may change at any time");
    model.set_parameter(friction, before);
    model.set_block_force(model.port_block(port), {1, 2}, 3);
    must(model.block_force(model.port_block(port)).second == 3, "an input is what was set");
    must(model.inputs().gravity.y == -9.81, "gravity is that of the case");
    try {
        enmm::batch_step({&model}, h, 0);
        must(false, "no thread throws");
    } catch (const enmm::Error &error) {
        must(error.status() == ENMM_INVALID_ARGUMENT, "the exception tells the status");
    }
}

void run(const char *path)
{
    enmm::Model model = enmm::Model::from_file(path);
    int messages = 0;
    model.set_log([&](enmm_log_level, const std::string &) { ++messages; });
    model.start();
    const std::uint32_t block = model.port_block(model.find_port("block"));
    const enmm::State rest = model.save();

    double weak = 0, strong = 12;
    must(holds(model, rest, block, weak, 0), "the block rests without shaking");
    must(!holds(model, rest, block, strong, 0), "strong shaking moves the block");
    must(messages > 0 && !model.events().empty(), "a moving block is an event");
    while (strong - weak > 0.1) {
        const double middle = 0.5 * (weak + strong);
        (holds(model, rest, block, middle, 0) ? weak : strong) = middle;
    }
    std::printf("the block fails at a base acceleration between %.2f and %.2f m/s2\n", weak, strong);
    must(weak > 3 && strong < 11, "friction tells when the block moves");

    const double mass = model.block_states().at(block).mass;
    must(holds(model, rest, block, strong, 0.5 * mass * strong), "support against the motion holds the block");

    const auto bytes = model.serialize(rest);
    enmm::Model other = std::move(model);
    model = enmm::Model::from_file(path);
    const enmm::State copy = model.deserialize(bytes);
    must(holds(model, copy, block, weak, 0) && holds(other, rest, block, weak, 0), "both hold");
    must(model.energies().kinetic == other.energies().kinetic, "a state from bytes gives the same bits");
    must(model.case_hash() == other.case_hash(), "both are of one case");

    const auto outline = model.block_polygon(block);
    const auto state = model.block_states().at(block);
    must(outline.size() >= 3, "a block has an outline");
    must(model.find_block_at({state.centroid_x, state.centroid_y}) == block, "a block is where its centroid is");
    must(!model.find_block_at({1e6, 1e6}), "no rock is far away");
    samples_are_as_single_calls(model, copy, model.find_port("block"));
    errors_are_exceptions(model);
    calls_can_be_stopped(model);

    other.set_log([](enmm_log_level, const std::string &) { throw 7; });
    try {
        other.do_step(-1, 1);
        must(false, "what the log throws comes out");
    } catch (int seven) {
        must(seven == 7, "what the log throws comes out whole");
    }
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s CASE.toml\n", argv[0]);
        return 2;
    }
    try {
        run(argv[1]);
    } catch (const enmm::Error &error) {
        std::fprintf(stderr, "status %d: %s\n", static_cast<int>(error.status()), error.what());
        return 1;
    }
    std::printf("%d checks failed\n", wrong);
    return wrong ? 1 : 0;
}
