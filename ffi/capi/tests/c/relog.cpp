/*
 * A log may replace itself, stop itself, move its model and destroy it while it speaks. Argument: case file. Made to run
 * under the address sanitizer.
 */
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "enmm.hpp"

namespace {

int wrong = 0;

void must(bool holds, const char *what)
{
    if (!holds) {
        ++wrong;
        std::fprintf(stderr, "not so: %s\n", what);
    }
}

/** A model that is about to say something in every step. */
enmm::Model restless(const char *path)
{
    enmm::Model model = enmm::Model::from_file(path);
    model.start();
    model.set_gravity({20, -9.81});
    return model;
}

/** A step with two events or more. */
void leap(enmm::Model &model) { model.do_step(model.time(), 0.2); }

void replaces_itself(const char *path)
{
    enmm::Model model = restless(path);
    int first = 0, second = 0;
    const auto token = std::make_shared<std::string>("held by the first log");
    model.set_log([&, token](enmm_log_level, const std::string &) {
        ++first;
        model.set_log([&](enmm_log_level, const std::string &) { ++second; });
        must(*token == "held by the first log", "a log that was replaced ends in peace");
    });
    leap(model);
    must(first == 1 && second >= 1, "the rest of the messages go to the new log");
    must(token.use_count() == 1, "a log that was replaced goes when it has spoken");
}

void stops_itself(const char *path)
{
    enmm::Model model = restless(path);
    int count = 0;
    const auto token = std::make_shared<int>(7);
    model.set_log([&, token](enmm_log_level, const std::string &) {
        ++count;
        model.set_log(nullptr);
        must(*token == 7, "a log that was stopped ends in peace");
    });
    leap(model);
    must(count == 1, "a log that was stopped says nothing more");
}

void destroys_its_model(const char *path)
{
    std::optional<enmm::Model> model = restless(path);
    int count = 0;
    const auto token = std::make_shared<int>(7);
    model->set_log([&, token](enmm_log_level, const std::string &) {
        ++count;
        model.reset();
        must(*token == 7, "a log whose model is gone ends in peace");
    });
    leap(*model);
    must(count == 1 && token.use_count() == 1, "a model that is gone says nothing more");
    model = restless(path);
    model->set_log([&](enmm_log_level, const std::string &) {
        model.reset();
        throw std::runtime_error("gone");
    });
    try {
        leap(*model);
        must(false, "the last exception of a model that is gone comes out");
    } catch (const std::runtime_error &error) {
        must(std::string(error.what()) == "gone", "it is that of the log");
    }
}

void moves_its_model(const char *path)
{
    auto model = std::make_unique<enmm::Model>(restless(path));
    int count = 0;
    model->set_log([&](enmm_log_level, const std::string &) {
        ++count;
        model = std::make_unique<enmm::Model>(std::move(*model));
    });
    leap(*model);
    must(count >= 2, "a model that was moved goes on speaking");
}

void steps_inside(const char *path)
{
    enmm::Model model = restless(path);
    int depth = 0, caught = 0;
    model.set_log([&](enmm_log_level level, const std::string &) {
        if (level == ENMM_LOG_ERROR)
            throw std::runtime_error("inner");
        if (depth++ > 0)
            return;
        try {
            model.do_step(-1, 0.01);
        } catch (const std::runtime_error &error) {
            caught += std::string(error.what()) == "inner";
        }
    });
    leap(model);
    must(caught == 1, "what a log throws comes out of the call that it speaks in");
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    replaces_itself(argv[1]);
    stops_itself(argv[1]);
    destroys_its_model(argv[1]);
    moves_its_model(argv[1]);
    steps_inside(argv[1]);
    return wrong == 0 ? 0 : 1;
}
