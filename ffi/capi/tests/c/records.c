/* Results are in the folder when a recording has ended, by its call or with its model; no result changes by it. */
#include <stdlib.h>

#include "check.h"
#include "state_bytes.h"

#define SIZE 300

static enmm_model *create(const char *path)
{
    enmm_model *model = NULL;
    OK(enmm_create_from_file(path, &model));
    return model;
}

static int is_there(const char *folder, const char *name)
{
    char path[SIZE];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "rb");
    if (file)
        fclose(file);
    return file != NULL;
}

/* Bytes of the state after ten steps. */
static unsigned char *moved(enmm_model *model, size_t *size)
{
    for (int k = 0; k < 10; k++)
        OK(enmm_do_step(model, 0.01 * k, 0.01, NULL));
    return bytes_of(model, size);
}

static void on_log(void *user, enmm_log_level level, const char *message)
{
    *(int *)user += level == ENMM_LOG_ERROR && strstr(message, "recording has ended") != NULL;
}

int main(int argc, char **argv)
{
    const char *path = argv[1], *folder = argv[2];
    enmm_model *plain, *model;
    unsigned char *bytes, *recorded;
    size_t size = 0, size_recorded = 0;
    char below[SIZE];
    int errors = 0;
    if (argc != 3)
        return 2;
    plain = create(path);
    model = create(path);
    bytes = moved(plain, &size);
    OK(enmm_record(model, folder));
    CHECK(enmm_record(model, folder) == ENMM_INVALID_ARGUMENT && is_there(folder, "history.csv"));
    CHECK(enmm_record(plain, folder) == ENMM_FILE_ERROR && strstr(enmm_last_error(), "is writing its results here"));
    recorded = moved(model, &size_recorded);
    CHECK(size == size_recorded && memcmp(bytes, recorded, size) == 0);
    OK(enmm_write_frame(model));
    CHECK(is_there(folder, "run.pvd") && !is_there(folder, "summary.json"));
    OK(enmm_end_record(model));
    CHECK(is_there(folder, "summary.json") && is_there(folder, "report.html") && is_there(folder, "checkpoint.enmm"));
    CHECK(enmm_end_record(model) == ENMM_INVALID_ARGUMENT);
    snprintf(below, sizeof below, "%s/history.csv/below", folder);
    CHECK(enmm_record(model, below) == ENMM_FILE_ERROR);
    snprintf(below, sizeof below, "%s/summary.json", folder);
    CHECK(remove(below) == 0);
    OK(enmm_record(model, folder));
    enmm_destroy(model);
    CHECK(is_there(folder, "summary.json"));
    CHECK(enmm_record(model, folder) == ENMM_DEAD_HANDLE && enmm_end_record(model) == ENMM_DEAD_HANDLE);
    /* A history that is no longer there: the steps go on. */
    OK(enmm_set_log_callback(plain, on_log, &errors));
    OK(enmm_record(plain, folder));
    snprintf(below, sizeof below, "%s/history.csv", folder);
    CHECK(remove(below) == 0);
    OK(enmm_do_step(plain, 0.1, 0.01, NULL));
    CHECK(enmm_end_record(plain) == ENMM_FILE_ERROR && enmm_end_record(plain) == ENMM_INVALID_ARGUMENT);
    enmm_destroy(plain);
    free(bytes);
    free(recorded);
    return CHECKS_RESULT;
}
