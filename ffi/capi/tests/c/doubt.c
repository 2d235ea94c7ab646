/*
 * The log receives one warning of energy from nowhere where the steps of a case are too long for its motion, and none
 * where they are not. Arguments: a case of each kind.
 */
#include "check.h"

static void on_log(void *user, enmm_log_level level, const char *message)
{
    int *doubts = user;
    if (strncmp(message, "the energy residual is ", 23) == 0) {
        CHECK(level == ENMM_LOG_WARNING);
        ++*doubts;
    }
}

static int doubts_of(const char *path)
{
    enmm_model *model = NULL;
    int doubts = 0;
    OK(enmm_create_from_file(path, &model));
    OK(enmm_set_log_callback(model, on_log, &doubts));
    OK(enmm_start(model));
    enmm_destroy(model);
    return doubts;
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    CHECK(doubts_of(argv[1]) == 1);
    CHECK(doubts_of(argv[2]) == 0);
    return CHECKS_RESULT;
}
