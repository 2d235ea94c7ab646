/* A host that loads the library of an FMU and calls what it reads from standard input, one call a line:
 *
 *     host FMI_VERSION LIBRARY RESOURCES TOKEN
 *
 * Each line gets one line as its answer: the status, then values. Numbers are the bits of a double in 16 hexadecimal
 * digits. python_tests/fmu_hosted.py writes the lines. The prototypes are those of the standards FMI 2.0.4 and 3.0. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
static HMODULE library;
static void *address(const char *name) { return (void *)(uintptr_t)GetProcAddress(library, name); }
static bool load(const char *path) { return (library = LoadLibraryA(path)) != NULL; }
#else
#include <dlfcn.h>
static void *library;
static void *address(const char *name) { return dlsym(library, name); }
static bool load(const char *path) { return (library = dlopen(path, RTLD_NOW)) != NULL; }
#endif

enum { STATES_MAX = 16, VALUES_MAX = 4096, FAILED = 4 };

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} callbacks2;

static int version;
static void *instance;
static void *states[STATES_MAX];
static int n_states;

static void heard2(void *environment, const char *name, int status, const char *category, const char *form, ...)
{
    (void)environment, (void)name, (void)form;
    fprintf(stderr, "status %d, %s\n", status, category);
}

static void heard3(void *environment, int status, const char *category, const char *text)
{
    (void)environment;
    fprintf(stderr, "status %d, %s: %s\n", status, category, text);
}

/* The function of this version; the program ends where the library has none. */
static void *function(const char *name2, const char *name3)
{
    char name[64];
    void *found;
    snprintf(name, sizeof name, "fmi%d%s", version, version == 2 ? name2 : name3);
    found = address(name);
    if (!found) {
        fprintf(stderr, "the library has no %s\n", name);
        exit(2);
    }
    return found;
}

static double number(const char *digits)
{
    uint64_t bits = strtoull(digits, NULL, 16);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void print(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    printf(" %08" PRIx32 "%08" PRIx32, (uint32_t)(bits >> 32), (uint32_t)bits);
}

static void instantiate(const char *resources, const char *token)
{
    static const callbacks2 callbacks = {heard2, calloc, free, NULL, NULL};
    if (version == 2) {
        void *(*make)(const char *, int, const char *, const char *, const callbacks2 *, int, int) =
            function("Instantiate", "");
        instance = make("slope", 1, token, resources, &callbacks, 0, 0);
    } else {
        void *(*make)(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t,
                      void *, void (*)(void *, int, const char *, const char *), void *) =
            function("", "InstantiateCoSimulation");
        instance = make("slope", token, resources, false, false, false, false, NULL, 0, NULL, heard3, NULL);
    }
}

static int initialize(double start)
{
    int (*leave)(void *) = function("ExitInitializationMode", "ExitInitializationMode");
    int status;
    if (version == 2) {
        int (*set_up)(void *, int, double, double, int, double) = function("SetupExperiment", "");
        int (*enter)(void *) = function("EnterInitializationMode", "");
        status = set_up(instance, 0, 0.0, start, 0, 0.0);
        status = status ? status : enter(instance);
    } else {
        int (*enter)(void *, bool, double, double, bool, double) = function("", "EnterInitializationMode");
        status = enter(instance, false, 0.0, start, false, 0.0);
    }
    return status ? status : leave(instance);
}

static int step(double time, double length)
{
    if (version == 2) {
        int (*act)(void *, double, double, int) = function("DoStep", "");
        return act(instance, time, length, 1);
    } else {
        int (*act)(void *, double, double, bool, bool *, bool *, bool *, double *) = function("", "DoStep");
        bool event, terminate, early;
        double last;
        return act(instance, time, length, true, &event, &terminate, &early, &last);
    }
}

/* Gets or sets values of one variable; `kind` is R for doubles, I for integers, B for booleans. */
static int transfer(bool set, char kind, uint32_t reference, double *values, size_t n)
{
    static int32_t integers[VALUES_MAX];
    static bool booleans[VALUES_MAX];
    const bool narrow = kind == 'B' && version == 3;
    const char *names2[] = {set ? "SetReal" : "GetReal", set ? "SetInteger" : "GetInteger",
                            set ? "SetBoolean" : "GetBoolean"};
    const char *names3[] = {set ? "SetFloat64" : "GetFloat64", set ? "SetInt32" : "GetInt32", names2[2]};
    const int k = kind == 'R' ? 0 : kind == 'I' ? 1 : 2;
    void *place = kind == 'R' ? (void *)values : narrow ? (void *)booleans : (void *)integers;
    void *found = function(names2[k], names3[k]);
    size_t i;
    int status;
    for (i = 0; i < n; i++) {
        integers[i] = (int32_t)values[i];
        booleans[i] = values[i] != 0.0;
    }
    if (version == 2) {
        int (*act)(void *, const uint32_t *, size_t, void *) = found;
        status = act(instance, &reference, 1, place);
    } else {
        int (*act)(void *, const uint32_t *, size_t, void *, size_t) = found;
        status = act(instance, &reference, 1, place, n);
    }
    for (i = 0; i < n && kind != 'R'; i++)
        values[i] = narrow ? (double)booleans[i] : (double)integers[i];
    return status;
}

static int save(void)
{
    int (*act)(void *, void **) = function("GetFMUstate", "GetFMUState");
    return n_states < STATES_MAX ? act(instance, &states[n_states++]) : FAILED;
}

static int restore(int k)
{
    int (*act)(void *, void *) = function("SetFMUstate", "SetFMUState");
    return k < n_states ? act(instance, states[k]) : FAILED;
}

/* Prints the bytes of a saved state behind its status. */
static void serialize(int k)
{
    int (*measure)(void *, void *, size_t *) = function("SerializedFMUstateSize", "SerializedFMUStateSize");
    int (*act)(void *, void *, uint8_t *, size_t) = function("SerializeFMUstate", "SerializeFMUState");
    size_t n = 0, i;
    int status = k < n_states ? measure(instance, states[k], &n) : FAILED;
    uint8_t *bytes = malloc(n ? n : 1);
    status = status ? status : act(instance, states[k], bytes, n);
    printf("%d ", status);
    for (i = 0; i < n && !status; i++)
        printf("%02x", bytes[i]);
    free(bytes);
}

/* Does what a line asks for; returns false at its end. */
static bool answer(void)
{
    static double values[VALUES_MAX];
    char word[32], a[32], b[32], kind;
    uint32_t reference;
    int k, n, i, status;
    if (scanf("%31s", word) != 1)
        return false;
    if (strcmp(word, "initialize") == 0 && scanf("%31s", a) == 1) {
        printf("%d", initialize(number(a)));
    } else if (strcmp(word, "step") == 0 && scanf("%31s %31s", a, b) == 2) {
        printf("%d", step(number(a), number(b)));
    } else if ((strcmp(word, "get") == 0 || strcmp(word, "set") == 0)
               && scanf(" %c %" SCNu32 " %d", &kind, &reference, &n) == 3 && n <= VALUES_MAX) {
        for (i = 0; i < n && word[0] == 's'; i++)
            values[i] = scanf("%31s", a) == 1 ? number(a) : 0.0;
        status = transfer(word[0] == 's', kind, reference, values, (size_t)n);
        printf("%d", status);
        for (i = 0; i < n && word[0] == 'g'; i++)
            print(values[i]);
    } else if (strcmp(word, "save") == 0) {
        printf("%d", save());
    } else if (strcmp(word, "restore") == 0 && scanf("%d", &k) == 1) {
        printf("%d", restore(k));
    } else if (strcmp(word, "serialize") == 0 && scanf("%d", &k) == 1) {
        serialize(k);
    } else {
        return false;
    }
    printf("\n");
    fflush(stdout);
    return true;
}

int main(int count, char **words)
{
    if (count != 5 || (version = atoi(words[1])) < 2 || version > 3 || !load(words[2])) {
        fprintf(stderr, "usage: host 2|3 LIBRARY RESOURCES TOKEN; or the library cannot be loaded\n");
        return 2;
    }
    instantiate(words[3], words[4]);
    if (!instance)
        return 1;
    while (answer())
        ;
    {
        int (*release_state)(void *, void **) = function("FreeFMUstate", "FreeFMUState");
        void (*release)(void *) = function("FreeInstance", "FreeInstance");
        while (n_states > 0)
            release_state(instance, &states[--n_states]);
        release(instance);
    }
    return 0;
}
