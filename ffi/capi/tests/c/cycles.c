/* Many lives of a model; the memory of the process must not grow. Arguments: case file, number of cycles. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <unistd.h>

#include "check.h"

/* Resident memory (MB). */
static double resident(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file == NULL || fscanf(file, "%*s %ld", &pages) != 1)
        pages = 0;
    if (file != NULL)
        fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE) / 1e6;
}

static void cycle(const char *path)
{
    enmm_model *model = NULL;
    enmm_state *state = NULL;
    size_t size;
    OK(enmm_create_from_file(path, &model));
    OK(enmm_do_step(model, 0, 0.01, NULL));
    OK(enmm_state_save(model, &state));
    OK(enmm_state_serialize(model, state, NULL, 0, &size));
    OK(enmm_do_step(model, 0.01, 0.01, NULL));
    OK(enmm_state_restore(model, state));
    OK(enmm_state_free(state));
    enmm_destroy(model);
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    for (int k = 0; k < 5; k++)
        cycle(argv[1]);
    const double before = resident();
    for (int k = 0; k < atoi(argv[2]); k++)
        cycle(argv[1]);
    const double growth = resident() - before;
    printf("%s cycles: resident memory grew by %.2f MB to %.1f MB\n", argv[2], growth, before + growth);
    CHECK(growth < 20);
    return CHECKS_RESULT;
}
