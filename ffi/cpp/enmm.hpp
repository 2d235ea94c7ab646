/*
 * C++17 over enmm.h: models and states that clean up after themselves, exceptions instead of statuses, vectors instead of
 * buffers. Header only; link with the library of enmm.h, which documents units, signs and when a value takes effect.
 */
#ifndef ENMM_HPP
#define ENMM_HPP

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "enmm.h"

namespace enmm {

/** A call that did nothing, with its status and the message of the library. */
class Error : public std::runtime_error {
public:
    Error(enmm_status status, const std::string &message) : std::runtime_error(message), status_(status) {}

    /** Status of the call. */
    enmm_status status() const noexcept { return status_; }

private:
    enmm_status status_;
};

/** A point or vector. */
struct Vector {
    double x = 0;
    double y = 0;
};

/** Inputs of the whole model as they are set. */
struct Inputs {
    Vector gravity;
    Vector base_acceleration;
    double water_level = 0;
    double strength_factor = 1;
};

/** Inputs of a port as they are set. */
struct PortInputs {
    Vector traction;
    double pressure = 0;
    Vector velocity;
};

/** Least and greatest value of a parameter, and whether it may change after the start. */
struct Range {
    double low = 0;
    double high = 0;
    bool is_tunable = false;
};

using BlockState = enmm_block_state;
using Contact = enmm_contact;
using Energies = enmm_energies;
using Event = enmm_event;
using Cut = enmm_cut;
using InletState = enmm_inlet_state;
using MonitorState = enmm_monitor_state;
using PortState = enmm_port_state;
using Progress = enmm_progress;
using StartInfo = enmm_start_info;
using StepInfo = enmm_step_info;
using Totals = enmm_totals;

/** Structures in the memory of the library. */
template <class T>
class View {
public:
    View(const T *first, std::size_t stride, std::size_t count) : first_(first), stride_(stride), count_(count) {}

    std::size_t size() const noexcept { return count_; }

    const T &operator[](std::size_t k) const noexcept
    {
        return *reinterpret_cast<const T *>(reinterpret_cast<const char *>(first_) + k * stride_);
    }

private:
    const T *first_;
    std::size_t stride_;
    std::size_t count_;
};

namespace detail {

inline void check(enmm_status status)
{
    if (status != ENMM_OK)
        throw Error(status, enmm_last_error());
}

template <class T>
T sized() noexcept
{
    T value{};
    value.struct_size = sizeof(T);
    return value;
}

/** A number that `get(handle, &number)` returns. */
template <class T, class Get>
T number(enmm_model *model, Get get)
{
    T value{};
    check(get(model, &value));
    return value;
}

/** Values that `get(buffer, capacity, written)` writes into a buffer of the size it asks for. */
template <class T, class Get>
std::vector<T> list(const T &like, Get get)
{
    std::size_t count = 0;
    check(get(nullptr, 0, &count));
    std::vector<T> values(count, like);
    check(get(values.data(), values.size(), &count));
    values.resize(count, like);
    return values;
}

/** The same for texts, without the closing zero. */
template <class Get>
std::string text(Get get)
{
    const std::vector<char> letters = list<char>('\0', get);
    return letters.data();
}

} // namespace detail

/** A saved state. It can be moved, not copied, and may outlive its model. */
class State {
public:
    State(State &&other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}

    State &operator=(State &&other) noexcept
    {
        std::swap(handle_, other.handle_);
        return *this;
    }

    State(const State &) = delete;
    State &operator=(const State &) = delete;

    ~State() { enmm_state_free(handle_); }

    /** Handle for calls of enmm.h; it stays owned by this object. */
    enmm_state *handle() const noexcept { return handle_; }

private:
    friend class Model;
    explicit State(enmm_state *handle) noexcept : handle_(handle) {}

    enmm_state *handle_;
};

/** Samples that go on from saved states, each with parameters of its own; see enmm_rollout. */
struct Rollout {
    std::size_t samples = 0;
    /** One state for all samples, or one for each. */
    std::vector<const State *> states;
    /** Names of the parameters that are set in each sample. */
    std::vector<std::string> parameters;
    /** Their values, those of one sample after those of another. */
    std::vector<double> values;
    /** Communication step (s), and how many of them. */
    double step = 0;
    std::size_t steps = 0;
    /** Ports, and places among the members of PortState behind struct_size. */
    std::vector<std::pair<std::uint32_t, std::uint32_t>> outputs;
    std::size_t threads = 1;
};

/** What a rollout brings. */
struct RolledOut {
    /** Outputs, those of one step after those of another, sample by sample; not a number behind a failure. */
    std::vector<double> values;
    /** Status of each sample. */
    std::vector<enmm_status> statuses;
};

/** Checks a case in TOML without a model of it; files that it names are sought in `base_dir`. Throws as Model does. */
inline void check_case(const std::string &toml, const std::string &base_dir = ".")
{
    detail::check(enmm_check_case(toml.c_str(), base_dir.c_str()));
}

/**
 * A model. It can be moved, not copied; a model that was moved from can only be assigned to or destroyed. Its log may
 * use it, set another log, move it and destroy it. While one thread is in a call, others must not move or destroy it.
 */
class Model {
public:
    using Log = std::function<void(enmm_log_level, const std::string &)>;
    /** Sees a call in progress; false ends it. */
    using Watch = std::function<bool(const Progress &)>;

    /** Builds the model of a case file. */
    static Model from_file(const std::string &path)
    {
        Model model;
        detail::check(enmm_create_from_file(path.c_str(), &model.handle_));
        return model;
    }

    /** Builds the model of a case in TOML; files that it names are sought in `base_dir`. */
    static Model from_string(const std::string &toml, const std::string &base_dir = ".")
    {
        Model model;
        detail::check(enmm_create_from_string(toml.c_str(), base_dir.c_str(), &model.handle_));
        return model;
    }

    Model(Model &&other) noexcept : handle_(std::exchange(other.handle_, nullptr)), desk_(std::move(other.desk_)) {}

    Model &operator=(Model &&other) noexcept
    {
        std::swap(handle_, other.handle_);
        std::swap(desk_, other.desk_);
        return *this;
    }

    Model(const Model &) = delete;
    Model &operator=(const Model &) = delete;

    ~Model() { enmm_destroy(handle_); }

    /** Handle for calls of enmm.h; it stays owned by this object. */
    enmm_model *handle() const noexcept { return handle_; }

    // Time.

    /** Seeks the initial equilibrium, which need not be reached: see `settled` of what it returns. */
    StartInfo start()
    {
        auto info = detail::sized<StartInfo>();
        call([&, handle = handle_](Frame &) {
            const enmm_status status = enmm_start(handle);
            if (status == ENMM_OK)
                (void)enmm_get_start_info(handle, &info); // which is empty when the log has ended the model
            return status;
        });
        return info;
    }

    StartInfo start_info() const { return filled<StartInfo>(enmm_get_start_info); }

    StepInfo do_step(double t, double h)
    {
        auto info = detail::sized<StepInfo>();
        call([&](Frame &) { return enmm_do_step(handle_, t, h, &info); });
        return info;
    }

    /** Ends the start or do_step that is in progress in another thread, which throws ENMM_INTERRUPTED. */
    void interrupt() const { detail::check(enmm_interrupt(handle_)); }

    /**
     * Sets what sees calls in progress, at most every 50 ms; an empty function for nothing. What it throws ends the call
     * and comes out of it. It must not use the model, but for interrupt.
     */
    void set_progress(Watch watch)
    {
        const enmm_progress_callback callback = watch ? look : nullptr;
        auto fresh = std::make_shared<const Watch>(std::move(watch));
        call([&](Frame &frame) {
            const enmm_status status = enmm_set_progress_callback(handle_, callback, frame.desk.get());
            if (status == ENMM_OK) {
                const std::lock_guard<std::mutex> guard(frame.desk->mutex);
                frame.desk->watch.swap(fresh);
            }
            return status;
        });
    }

    double time() const { return detail::number<double>(handle_, enmm_get_time); }
    double internal_step() const { return detail::number<double>(handle_, enmm_get_internal_step); }
    double communication_step() const { return detail::number<double>(handle_, enmm_get_communication_step); }
    double stop_time() const { return detail::number<double>(handle_, enmm_get_stop_time); }

    // Inputs.

    void set_gravity(Vector g) { detail::check(enmm_set_gravity(handle_, g.x, g.y)); }
    void set_base_acceleration(Vector a) { detail::check(enmm_set_base_acceleration(handle_, a.x, a.y)); }
    void set_water_level(double y) { detail::check(enmm_set_water_level(handle_, y)); }
    void set_strength_factor(double factor) { detail::check(enmm_set_strength_factor(handle_, factor)); }
    enmm_interpolation interpolation() const {
        int32_t mode = 0;
        detail::check(enmm_get_interpolation(handle_, &mode));
        return static_cast<enmm_interpolation>(mode);
    }
    void set_interpolation(enmm_interpolation mode) { detail::check(enmm_set_interpolation(handle_, mode)); }
    void set_threads(std::size_t threads) { detail::check(enmm_set_threads(handle_, threads)); }

    void set_block_force(std::uint32_t block, Vector force, double moment = 0)
    {
        detail::check(enmm_set_block_force(handle_, block, force.x, force.y, moment));
    }

    /** All lists must have the length of `ids`. */
    void set_block_forces(const std::vector<std::uint32_t> &ids, const std::vector<double> &fx,
                          const std::vector<double> &fy, const std::vector<double> &moment)
    {
        if (fx.size() != ids.size() || fy.size() != ids.size() || moment.size() != ids.size())
            throw Error(ENMM_INVALID_ARGUMENT, "ids, fx, fy and moment must have the same length");
        detail::check(enmm_set_block_forces(handle_, ids.data(), ids.size(), fx.data(), fy.data(), moment.data()));
    }

    void set_boundary_traction(std::uint32_t port, Vector traction)
    {
        detail::check(enmm_set_boundary_traction(handle_, port, traction.x, traction.y));
    }

    void set_boundary_pressure(std::uint32_t port, double p)
    {
        detail::check(enmm_set_boundary_pressure(handle_, port, p));
    }

    void set_joint_pressure(std::uint32_t port, double p) { detail::check(enmm_set_joint_pressure(handle_, port, p)); }

    /** Velocity of moved supports, or of the wave that comes in through a quiet boundary. */
    void set_port_velocity(std::uint32_t port, Vector v)
    {
        detail::check(enmm_set_port_velocity(handle_, port, v.x, v.y));
    }

    /** Displacement that moved supports have reached at the end of the next step. */
    void set_port_displacement(std::uint32_t port, Vector u)
    {
        detail::check(enmm_set_port_displacement(handle_, port, u.x, u.y));
    }

    /** Level of a head, by its place in the case (m); it acts where the flow in joints is found. */
    void set_head(std::uint32_t head, double level) { detail::check(enmm_set_head(handle_, head, level)); }

    /** Rate of rain on each square metre in plan (m/s). */
    void set_rain(std::uint32_t rain, double rate) { detail::check(enmm_set_rain(handle_, rain, rate)); }

    /** Whether a drain acts. */
    void set_drain(std::uint32_t drain, bool is_active)
    {
        detail::check(enmm_set_drain(handle_, drain, is_active ? 1 : 0));
    }

    /** How one input varies within a step; `of` is the block, port, head, rain or drain where it has one. */
    void set_interpolation_of(enmm_input input, enmm_interpolation mode, std::uint32_t of = 0)
    {
        detail::check(enmm_set_input_interpolation(handle_, input, of, mode));
    }

    /** Inputs that were set since the last step act at once from the start of the next one. */
    void jump() { detail::check(enmm_jump(handle_)); }

    Inputs inputs() const
    {
        Inputs inputs;
        double gravity[2], base[2];
        detail::check(enmm_get_inputs(handle_, gravity, base, &inputs.water_level, &inputs.strength_factor));
        inputs.gravity = {gravity[0], gravity[1]};
        inputs.base_acceleration = {base[0], base[1]};
        return inputs;
    }

    /** Force and moment on a block. */
    std::pair<Vector, double> block_force(std::uint32_t block) const
    {
        double force[2], moment = 0;
        detail::check(enmm_get_block_force(handle_, block, force, &moment));
        return {{force[0], force[1]}, moment};
    }

    PortInputs port_inputs(std::uint32_t port) const
    {
        PortInputs inputs;
        double traction[2], velocity[2];
        detail::check(enmm_get_port_inputs(handle_, port, traction, &inputs.pressure, velocity));
        inputs.traction = {traction[0], traction[1]};
        inputs.velocity = {velocity[0], velocity[1]};
        return inputs;
    }

    // Parameters.

    std::size_t parameter_count() const { return detail::number<std::size_t>(handle_, enmm_parameter_count); }

    std::uint32_t find_parameter(const std::string &name) const
    {
        std::uint32_t parameter = 0;
        detail::check(enmm_find_parameter(handle_, name.c_str(), &parameter));
        return parameter;
    }

    std::string parameter_name(std::uint32_t parameter) const
    {
        return detail::text([&](char *out, std::size_t capacity, std::size_t *written) {
            return enmm_parameter_name(handle_, parameter, out, capacity, written);
        });
    }

    std::string parameter_unit(std::uint32_t parameter) const
    {
        return detail::text([&](char *out, std::size_t capacity, std::size_t *written) {
            return enmm_parameter_unit(handle_, parameter, out, capacity, written);
        });
    }

    std::string parameter_description(std::uint32_t parameter) const
    {
        return detail::text([&](char *out, std::size_t capacity, std::size_t *written) {
            return enmm_parameter_description(handle_, parameter, out, capacity, written);
        });
    }

    Range parameter_range(std::uint32_t parameter) const
    {
        Range range;
        int32_t tunable = 0;
        detail::check(enmm_parameter_range(handle_, parameter, &range.low, &range.high, &tunable));
        range.is_tunable = tunable != 0;
        return range;
    }

    double parameter(const std::string &name) const
    {
        double value = 0;
        detail::check(enmm_get_parameter(handle_, find_parameter(name), &value));
        return value;
    }

    void set_parameter(const std::string &name, double value)
    {
        detail::check(enmm_set_parameter(handle_, find_parameter(name), value));
    }

    /** Sets several at once, or none of them. */
    void set_parameters(const std::vector<std::pair<std::string, double>> &values)
    {
        std::vector<std::uint32_t> parameters;
        std::vector<double> numbers;
        for (const auto &[name, value] : values) {
            parameters.push_back(find_parameter(name));
            numbers.push_back(value);
        }
        detail::check(enmm_set_parameters(handle_, parameters.data(), parameters.size(), numbers.data()));
    }

    // Ports.

    std::size_t port_count() const { return detail::number<std::size_t>(handle_, enmm_port_count); }

    std::uint32_t find_port(const std::string &name) const
    {
        std::uint32_t port = 0;
        detail::check(enmm_find_port(handle_, name.c_str(), &port));
        return port;
    }

    std::string port_name(std::uint32_t port) const
    {
        return detail::text([&](char *out, std::size_t capacity, std::size_t *written) {
            return enmm_port_name(handle_, port, out, capacity, written);
        });
    }

    enmm_port_type port_kind(std::uint32_t port) const
    {
        enmm_port_type kind{};
        detail::check(enmm_port_kind(handle_, port, &kind));
        return kind;
    }

    std::uint32_t port_block(std::uint32_t port) const
    {
        std::uint32_t block = 0;
        detail::check(enmm_port_block(handle_, port, &block));
        return block;
    }

    PortState port_state(std::uint32_t port) const
    {
        auto state = detail::sized<PortState>();
        detail::check(enmm_get_port_state(handle_, port, &state));
        return state;
    }

    // Names.

    /** Names of all things of a kind by their numbers; see enmm_name for what the case does not name. */
    std::vector<std::string> names(enmm_name_kind kind) const
    {
        std::size_t count = 0;
        detail::check(enmm_name_count(handle_, kind, &count));
        std::vector<std::string> found;
        for (std::uint32_t k = 0; k < count; ++k)
            found.push_back(name(kind, k));
        return found;
    }

    std::string name(enmm_name_kind kind, std::uint32_t index) const
    {
        return detail::text([&](char *out, std::size_t capacity, std::size_t *written) {
            return enmm_name(handle_, kind, index, out, capacity, written);
        });
    }

    /** Number of the thing of a kind with a name. */
    std::uint32_t find_name(enmm_name_kind kind, const std::string &name) const
    {
        std::uint32_t index = 0;
        detail::check(enmm_find_name(handle_, kind, name.c_str(), &index));
        return index;
    }

    /** Water at a head, in rain or at a drain. */
    InletState inlet_state(enmm_name_kind kind, std::uint32_t index) const
    {
        auto state = detail::sized<InletState>();
        detail::check(enmm_get_inlet_state(handle_, kind, index, &state));
        return state;
    }

    /** Level of a head (m), rate of rain (m/s), or 1 for a drain that acts, as it is set. */
    double inlet_input(enmm_name_kind kind, std::uint32_t index) const
    {
        double value = 0;
        detail::check(enmm_get_inlet_input(handle_, kind, index, &value));
        return value;
    }

    MonitorState monitor_state(std::uint32_t monitor) const
    {
        auto state = detail::sized<MonitorState>();
        detail::check(enmm_get_monitor_state(handle_, monitor, &state));
        return state;
    }

    // The model now.

    std::size_t block_count() const { return detail::number<std::size_t>(handle_, enmm_block_count); }

    std::vector<BlockState> block_states() const { return list<BlockState>(enmm_get_block_states); }

    /** The same without a copy: it is there until the next call that changes the model. */
    View<BlockState> view_block_states() const
    {
        const BlockState *first = nullptr;
        std::size_t stride = 0, count = 0;
        detail::check(enmm_view_block_states(handle_, &first, &stride, &count));
        return {first, stride, count};
    }

    std::vector<Contact> contacts() const { return list<Contact>(enmm_get_contacts); }

    /** Most blocks that the model can have: those of its last stage, and fracture.parts_max more where rock can break. */
    std::size_t blocks_max() const { return detail::number<std::size_t>(handle_, enmm_blocks_max); }

    /** Sections of rock that have broken so far, in order. */
    std::vector<Cut> cuts() const { return list<Cut>(enmm_get_cuts); }

    /** Events from index `first` on. */
    std::vector<Event> events(std::size_t first = 0) const
    {
        return detail::list(detail::sized<Event>(), [&](Event *out, std::size_t capacity, std::size_t *written) {
            return enmm_get_events(handle_, first, out, capacity, written);
        });
    }

    Energies energies() const { return filled<Energies>(enmm_get_energies); }
    Totals totals() const { return filled<Totals>(enmm_get_totals); }

    /** Outer outline of a block, counter-clockwise. */
    std::vector<Vector> block_polygon(std::uint32_t block) const
    {
        return points([&](double *xy, std::size_t capacity, std::size_t *written) {
            return enmm_get_block_polygon(handle_, block, xy, capacity, written);
        });
    }

    /** Outlines of the holes of a block, clockwise. */
    std::vector<std::vector<Vector>> block_holes(std::uint32_t block) const
    {
        std::size_t count = 0;
        detail::check(enmm_block_hole_count(handle_, block, &count));
        std::vector<std::vector<Vector>> holes;
        for (std::uint32_t hole = 0; hole < count; ++hole)
            holes.push_back(points([&](double *xy, std::size_t capacity, std::size_t *written) {
                return enmm_get_block_hole(handle_, block, hole, xy, capacity, written);
            }));
        return holes;
    }

    /** The block at a place, or none. */
    std::optional<std::uint32_t> find_block_at(Vector place) const
    {
        std::uint32_t block = 0;
        const enmm_status status = enmm_find_block_at(handle_, place.x, place.y, &block);
        if (status == ENMM_NOT_FOUND)
            return std::nullopt;
        detail::check(status);
        return block;
    }

    std::string case_hash() const
    {
        return detail::text([&](char *out, std::size_t capacity, std::size_t *written) {
            return enmm_case_hash(handle_, out, capacity, written);
        });
    }

    // States.

    State save() const
    {
        enmm_state *state = nullptr;
        detail::check(enmm_state_save(handle_, &state));
        return State(state);
    }

    void restore(const State &state) { detail::check(enmm_state_restore(handle_, state.handle())); }

    /** As restore, but this model keeps its parameters; the state may be of one that differs in them. */
    void restore_keeping_parameters(const State &state)
    {
        detail::check(enmm_state_restore_with(handle_, state.handle(), ENMM_KEEP_PARAMETERS));
    }

    std::vector<std::uint8_t> serialize(const State &state) const
    {
        return detail::list<std::uint8_t>(0, [&](std::uint8_t *out, std::size_t capacity, std::size_t *written) {
            return enmm_state_serialize(handle_, state.handle(), out, capacity, written);
        });
    }

    State deserialize(const std::vector<std::uint8_t> &bytes) const { return deserialize_with(bytes, 0); }

    /** As deserialize, for a state that may be of a model that differs in its parameters. */
    State deserialize_keeping_parameters(const std::vector<std::uint8_t> &bytes) const
    {
        return deserialize_with(bytes, ENMM_KEEP_PARAMETERS);
    }

    // Many at once.

    /** Takes samples on from saved states; see Rollout. The model stays as it is. */
    RolledOut roll_out(const Rollout &plan) const
    {
        RolledOut made;
        made.values.resize(plan.samples * plan.steps * plan.outputs.size());
        std::vector<int32_t> statuses(plan.samples);
        std::vector<enmm_state *> states;
        for (const State *state : plan.states)
            states.push_back(state->handle());
        std::vector<std::uint32_t> parameters, ports, quantities;
        for (const std::string &name : plan.parameters)
            parameters.push_back(find_parameter(name));
        for (const auto &[port, quantity] : plan.outputs) {
            ports.push_back(port);
            quantities.push_back(quantity);
        }
        if (plan.values.size() != plan.samples * parameters.size())
            throw Error(ENMM_INVALID_ARGUMENT, "values must have one number for each sample and parameter");
        auto given = detail::sized<enmm_rollout_plan>();
        given.samples = plan.samples;
        given.states = states.data();
        given.state_count = states.size();
        given.parameters = parameters.data();
        given.parameter_count = parameters.size();
        given.values = plan.values.data();
        given.step = plan.step;
        given.steps = plan.steps;
        given.ports = ports.data();
        given.quantities = quantities.data();
        given.output_count = plan.outputs.size();
        given.threads = plan.threads;
        detail::check(enmm_rollout(handle_, &given, made.values.data(), made.values.size(), statuses.data()));
        for (const int32_t status : statuses)
            made.statuses.push_back(static_cast<enmm_status>(status));
        return made;
    }

    // Results.

    /** Records results into a folder from now on, as `enmm run` writes them; see enmm_record. */
    void record(const std::string &folder)
    {
        call([&](Frame &) { return enmm_record(handle_, folder.c_str()); });
    }

    /** Writes a row and frames of this instant at once. */
    void write_frame() { call([&](Frame &) { return enmm_write_frame(handle_); }); }

    /** Ends the recording with pictures, page and summary; the end of the model does so too, but without an error. */
    void end_record() { call([&](Frame &) { return enmm_end_record(handle_); }); }

    /**
     * Sets where messages go; an empty function stops them. What it throws comes out of the call of this object that it
     * speaks in.
     */
    void set_log(Log log)
    {
        const enmm_log_callback callback = log ? speak : nullptr;
        auto fresh = std::make_shared<const Log>(std::move(log));
        call([&](Frame &frame) {
            frame.fresh = std::move(fresh);
            const enmm_status status = enmm_set_log_callback(handle_, callback, frame.desk.get());
            if (status == ENMM_OK)
                frame.settle();
            return status;
        });
    }

private:
    /**
     * Where the library finds the log of a model: one place from the first to the last, so that the library never holds
     * a pointer to a log that was replaced. A log that speaks is held by its message.
     */
    struct Desk : std::enable_shared_from_this<Desk> {
        std::mutex mutex;
        std::shared_ptr<const Log> log;
        std::shared_ptr<const Watch> watch;

        std::shared_ptr<const Log> current()
        {
            const std::lock_guard<std::mutex> guard(mutex);
            return log;
        }

        std::shared_ptr<const Watch> watcher()
        {
            const std::lock_guard<std::mutex> guard(mutex);
            return watch;
        }
    };

    /** A call that messages can come in, the innermost of its thread. It holds the desk even when the model goes. */
    struct Frame {
        explicit Frame(std::shared_ptr<Desk> at) : desk(std::move(at)), outer(std::exchange(innermost(), this)) {}
        Frame(const Frame &) = delete;
        Frame &operator=(const Frame &) = delete;
        ~Frame() { innermost() = outer; }

        static Frame *&innermost() noexcept
        {
            thread_local Frame *frame = nullptr;
            return frame;
        }

        /** Puts a log that is being set in its place; the library has taken it. */
        void settle()
        {
            if (!fresh)
                return;
            {
                const std::lock_guard<std::mutex> guard(desk->mutex);
                desk->log.swap(fresh);
            }
            fresh.reset(); // the old one, which may call anything when it goes
        }

        std::shared_ptr<Desk> desk;
        Frame *outer;
        std::shared_ptr<const Log> fresh;
        std::exception_ptr thrown;
    };

    Model() : desk_(std::make_shared<Desk>()) {}

    /** No exception may pass the library: it waits in the frame until the call is over. */
    static void speak(void *user, enmm_log_level level, const char *message) noexcept
    {
        const auto desk = static_cast<Desk *>(user)->shared_from_this();
        Frame *const frame = Frame::innermost();
        const bool ours = frame && frame->desk == desk;
        try {
            if (ours)
                frame->settle();
            if (const auto log = desk->current(); log && *log)
                (*log)(level, message);
        } catch (...) {
            if (ours)
                frame->thrown = std::current_exception();
        }
    }

    /** No exception may pass the library: it waits in the frame until the call is over. */
    static int32_t look(const Progress *progress, void *user) noexcept
    {
        const auto desk = static_cast<Desk *>(user)->shared_from_this();
        Frame *const frame = Frame::innermost();
        try {
            const auto watch = desk->watcher();
            return watch && *watch && !(*watch)(*progress);
        } catch (...) {
            if (frame && frame->desk == desk)
                frame->thrown = std::current_exception();
            return 1;
        }
    }

    /** What it calls may destroy the model: nothing of this object is touched behind it. */
    template <class Call>
    void call(Call what)
    {
        Frame frame(desk_);
        const enmm_status status = what(frame);
        const std::string message = status == ENMM_OK ? "" : enmm_last_error();
        if (frame.thrown)
            std::rethrow_exception(frame.thrown);
        if (status != ENMM_OK)
            throw Error(status, message);
    }

    template <class T, class Get>
    T filled(Get get) const
    {
        auto value = detail::sized<T>();
        detail::check(get(handle_, &value));
        return value;
    }

    template <class T, class Get>
    std::vector<T> list(Get get) const
    {
        return detail::list(detail::sized<T>(), [&](T *out, std::size_t capacity, std::size_t *written) {
            return get(handle_, out, capacity, written);
        });
    }

    State deserialize_with(const std::vector<std::uint8_t> &bytes, std::uint32_t flags) const
    {
        enmm_state *state = nullptr;
        detail::check(enmm_state_deserialize_with(handle_, bytes.data(), bytes.size(), flags, &state));
        return State(state);
    }

    template <class Get>
    static std::vector<Vector> points(Get get)
    {
        std::size_t count = 0;
        detail::check(get(nullptr, 0, &count));
        std::vector<double> xy(2 * count);
        detail::check(get(xy.data(), count, &count));
        std::vector<Vector> points;
        for (std::size_t k = 0; k < count; ++k)
            points.push_back({xy[2 * k], xy[2 * k + 1]});
        return points;
    }

    enmm_model *handle_ = nullptr;
    std::shared_ptr<Desk> desk_;
};

/** Advances models by `h` (s) each, on some threads; returns the status of each, and throws for a wrong call alone. */
inline std::vector<enmm_status> batch_step(const std::vector<Model *> &models, double h, std::size_t threads = 1)
{
    std::vector<enmm_model *> handles;
    for (const Model *model : models)
        handles.push_back(model->handle());
    std::vector<int32_t> statuses(handles.size(), -1); // a wrong call leaves them
    const enmm_status first = enmm_batch_step(handles.data(), handles.size(), h, threads, statuses.data());
    std::vector<enmm_status> all;
    for (const int32_t status : statuses) {
        if (status < 0)
            detail::check(first);
        all.push_back(static_cast<enmm_status>(status));
    }
    return all;
}

} // namespace enmm

#endif
