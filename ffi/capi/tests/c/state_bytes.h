/* The state of a model as bytes, which the caller frees, and beside bytes of before. */
#ifndef STATE_BYTES_H
#define STATE_BYTES_H

#include <stdlib.h>

#include "check.h"

static unsigned char *bytes_of(enmm_model *model, size_t *size)
{
    unsigned char *bytes;
    enmm_state *state = NULL;
    OK(enmm_state_save(model, &state));
    OK(enmm_state_serialize(model, state, NULL, 0, size));
    bytes = malloc(*size);
    OK(enmm_state_serialize(model, state, bytes, *size, size));
    OK(enmm_state_free(state));
    return bytes;
}

/* Checks that the state of a model is that of bytes. */
static inline void check_bytes(enmm_model *model, const unsigned char *expected, size_t expected_size)
{
    size_t size;
    unsigned char *bytes = bytes_of(model, &size);
    CHECK(size == expected_size && memcmp(bytes, expected, size) == 0);
    free(bytes);
}

#endif
