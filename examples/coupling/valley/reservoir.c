/*
 * A reservoir as an FMU (FMI 2, co-simulation), to be connected with the FMU of a slope.
 *
 * The level follows from what flows in and from the water that the slope pushes away:
 *
 *     area * d(level)/dt = inflow - wet height * d(displacement_x)/dt,
 *
 * where the displacement is that of the wetted face, positive into the slope, and the wet height is that of the level
 * above the foot of the face. All is per metre of depth. Inputs hold over a step.
 */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef int status;
typedef unsigned reference;
enum { OK = 0, ERROR = 3 };

/* The value references of modelDescription.xml, in its order. */
enum { LEVEL, DISPLACEMENT_X, START_LEVEL, INFLOW, AREA, FOOT, VALUES };

static const double starts[VALUES] = {6.0, 0.0, 6.0, 130.0, 40.0, 8.0};

struct reservoir {
    double values[VALUES];
    double displacement_before;
};

EXPORT const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

EXPORT const char *fmi2GetVersion(void)
{
    return "2.0";
}

EXPORT status fmi2Reset(void *c)
{
    struct reservoir *r = c;
    memset(r, 0, sizeof *r);
    memcpy(r->values, starts, sizeof starts);
    return OK;
}

EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *functions,
                             int visible, int logging)
{
    struct reservoir *r = malloc(sizeof *r);
    (void)name, (void)type, (void)guid, (void)resources, (void)functions, (void)visible, (void)logging;
    if (r != NULL)
        fmi2Reset(r);
    return r;
}

EXPORT void fmi2FreeInstance(void *c)
{
    free(c);
}

EXPORT status fmi2SetupExperiment(void *c, int with_tolerance, double tolerance, double start, int with_stop, double stop)
{
    (void)c, (void)with_tolerance, (void)tolerance, (void)start, (void)with_stop, (void)stop;
    return OK;
}

EXPORT status fmi2EnterInitializationMode(void *c)
{
    (void)c;
    return OK;
}

EXPORT status fmi2ExitInitializationMode(void *c)
{
    (void)c;
    return OK;
}

EXPORT status fmi2Terminate(void *c)
{
    (void)c;
    return OK;
}

EXPORT status fmi2GetReal(void *c, const reference *which, size_t n, double *values)
{
    const struct reservoir *r = c;
    for (size_t k = 0; k < n; k++) {
        if (which[k] >= VALUES)
            return ERROR;
        values[k] = r->values[which[k]];
    }
    return OK;
}

EXPORT status fmi2SetReal(void *c, const reference *which, size_t n, const double *values)
{
    struct reservoir *r = c;
    for (size_t k = 0; k < n; k++) {
        if (which[k] >= VALUES || which[k] == LEVEL || !isfinite(values[k]))
            return ERROR;
        r->values[which[k]] = values[k];
        if (which[k] == START_LEVEL)
            r->values[LEVEL] = values[k];
    }
    return OK;
}

EXPORT status fmi2DoStep(void *c, double time, double h, int no_rollback)
{
    struct reservoir *r = c;
    const double *values = r->values;
    const double wet = fmax(values[LEVEL] - values[FOOT], 0.0);
    const double pushed = wet * (r->displacement_before - values[DISPLACEMENT_X]);
    (void)time, (void)no_rollback;
    r->values[LEVEL] += (h * values[INFLOW] + pushed) / values[AREA];
    r->displacement_before = values[DISPLACEMENT_X];
    return OK;
}

/* Functions that the standard wants and this model does not need. */
#define NONE(name, ...)                                                                                                 \
    EXPORT status name(void *c, __VA_ARGS__)                                                                            \
    {                                                                                                                   \
        (void)c;                                                                                                        \
        return n == 0 ? OK : ERROR;                                                                                     \
    }

NONE(fmi2SetDebugLogging, int on, size_t n, const char *const *names)
NONE(fmi2GetInteger, const reference *which, size_t n, int *values)
NONE(fmi2GetBoolean, const reference *which, size_t n, int *values)
NONE(fmi2GetString, const reference *which, size_t n, const char **values)
NONE(fmi2SetInteger, const reference *which, size_t n, const int *values)
NONE(fmi2SetBoolean, const reference *which, size_t n, const int *values)
NONE(fmi2SetString, const reference *which, size_t n, const char *const *values)
NONE(fmi2SetRealInputDerivatives, const reference *which, size_t n, const int *orders, const double *values)
NONE(fmi2GetRealOutputDerivatives, const reference *which, size_t n, const int *orders, double *values)

#define REFUSED(name, ...)                                                                                              \
    EXPORT status name(void *c, __VA_ARGS__)                                                                            \
    {                                                                                                                   \
        (void)c;                                                                                                        \
        return ERROR;                                                                                                   \
    }

REFUSED(fmi2GetFMUstate, void **state)
REFUSED(fmi2SetFMUstate, void *state)
REFUSED(fmi2FreeFMUstate, void **state)
REFUSED(fmi2SerializedFMUstateSize, void *state, size_t *size)
REFUSED(fmi2SerializeFMUstate, void *state, char *bytes, size_t size)
REFUSED(fmi2DeSerializeFMUstate, const char *bytes, size_t size, void **state)
REFUSED(fmi2GetDirectionalDerivative, const reference *unknown, size_t unknowns, const reference *known, size_t knowns,
        const double *seed, double *values)
REFUSED(fmi2GetStatus, int kind, status *value)
REFUSED(fmi2GetRealStatus, int kind, double *value)
REFUSED(fmi2GetIntegerStatus, int kind, int *value)
REFUSED(fmi2GetBooleanStatus, int kind, int *value)
REFUSED(fmi2GetStringStatus, int kind, const char **value)

EXPORT status fmi2CancelStep(void *c)
{
    (void)c;
    return ERROR;
}
