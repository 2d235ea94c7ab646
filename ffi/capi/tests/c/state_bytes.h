/* The state of a model as bytes, which the caller frees. */
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

#endif
