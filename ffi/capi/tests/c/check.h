/* Checks of the test programs: they print what is wrong and go on. CHECKS_RESULT is the exit status. */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <string.h>

#include "enmm.h"

static int checks_failed = 0;

#define CHECK(condition)                                                                        \
    do {                                                                                        \
        if (!(condition)) {                                                                     \
            checks_failed++;                                                                    \
            fprintf(stderr, "%s:%d: not so: %s [%s]\n", __FILE__, __LINE__, #condition, enmm_last_error()); \
        }                                                                                       \
    } while (0)

#define OK(call) CHECK((call) == ENMM_OK)

#define CHECKS_RESULT (checks_failed ? 1 : 0)

#endif
