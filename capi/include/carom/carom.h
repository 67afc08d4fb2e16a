/* The C interface of carom: impacts of two balls, many of them at once, and whole shots.
 *
 * Units are SI; the frame is right-handed, z up from the cloth, x along the short side of the table, y along
 * the long side, the origin where two nose lines meet. The state of a ball is nine doubles, row by row:
 * position [m], velocity [m/s], angular velocity [rad/s] ("rvw", a 3 x 3 array in other programs).
 *
 * Functions that can fail return a carom_status; carom_last_error() then says what is wrong and what to do.
 * Nothing is printed, nothing aborts, no exception leaves. Any function may be called from any thread; one
 * scene may be changed by one thread at a time, a record may be read by many. Every pointer has to be valid;
 * where NULL is allowed it is said.
 */
#ifndef CAROM_CAROM_H
#define CAROM_CAROM_H

#include <stddef.h>
#include <stdint.h>

#include "carom/version.h"

#if defined(CAROM_BUILDING_C_LIBRARY)
#define CAROM_API __attribute__((visibility("default")))
#else
#define CAROM_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* "0.1.0": of the library, while CAROM_VERSION is that of this header. */
CAROM_API const char* carom_version(void);

typedef enum carom_status {
    CAROM_OK = 0,
    CAROM_BAD_ARGUMENT = 1, /* an argument that cannot be used: NULL, an index or a name that is not there */
    CAROM_BAD_SCENE = 2,    /* the scene, or the file that it was to be read from */
    CAROM_FAILED = 3,       /* the simulation cannot go on */
    CAROM_NO_MEMORY = 4,
    CAROM_INTERNAL = 5 /* a defect of the library */
} carom_status;

/* What the last failed call of this thread said; "" before one. Valid until this thread's next failed call.
 */
CAROM_API const char* carom_last_error(void);

/* ---- Impacts ---- */

/* Balls of equal radius and mass. */
typedef struct carom_impact_params {
    double R;     /* radius [m] */
    double m;     /* mass [kg] */
    double mu_s1; /* sliding friction of ball 1 on the cloth, 0..1 */
    double mu_s2; /* of ball 2 */
    double mu_b;  /* friction between the balls, 0..1 */
    double e_b;   /* restitution, 0..1 */
} carom_impact_params;

typedef enum carom_impact_status {
    CAROM_IMPACT_OK = 0,
    CAROM_IMPACT_NOT_APPROACHING = 1, /* the balls leave as they came */
    CAROM_IMPACT_BAD_STATE = 2, /* not finite, centres that coincide or are not at one height: left alone */
    CAROM_IMPACT_BAD_PARAMETER = 3, /* out of range: left alone */
    CAROM_IMPACT_STEP_LIMIT = 4     /* not solved: left alone */
} carom_impact_status;

/* One impact of the model of Mathavan, Jackson and Parkin (2014), solved to `tolerance` (1e-13 to 1e-1) of
 * the approach speed. `out` may be `in`. CAROM_BAD_ARGUMENT where a state, a parameter or the tolerance
 * cannot be used; two balls that do not approach are CAROM_OK and leave as they came. */
CAROM_API carom_status carom_collide_balls(const double in1[9], const double in2[9],
                                           const carom_impact_params* params, double tolerance,
                                           double out1[9], double out2[9]);

/* `count` impacts at once, several times faster each: states one behind the other (count x 3 x 3), parameters
 * one for all (params_count = 1) or one each (params_count = count). `status` gets count carom_impact_status,
 * or is NULL. An impact that cannot be computed is left alone, the others are solved, and the call returns
 * CAROM_BAD_ARGUMENT. `out` may be `in`. The bound is that of carom_collide_balls, the bits may be others. */
CAROM_API carom_status carom_collide_balls_batch(size_t count, const double* in1, const double* in2,
                                                 const carom_impact_params* params, size_t params_count,
                                                 double tolerance, double* out1, double* out2,
                                                 int32_t* status);

/* ---- Scenes ---- */

typedef struct carom_scene carom_scene;

/* From a scene file, or its text (docs/scene_format.md); `name` stands for the file in messages. On failure
 * *scene is NULL. */
CAROM_API carom_status carom_scene_read(const char* path, carom_scene** scene);
CAROM_API carom_status carom_scene_parse(const char* text, const char* name, carom_scene** scene);

/* A table without balls: "seven_foot", "eight_foot", "nine_foot", "snooker" or "carom", or "" for an endless
 * cloth; balls "pool", "snooker" or "carom". */
CAROM_API carom_status carom_scene_create(const char* table, const char* balls, carom_scene** scene);
CAROM_API void carom_scene_free(carom_scene* scene); /* NULL is allowed */

/* One number of the balls: "radius", "mass", "mu_s", "mu_r", "mu_sp", "mu_b", "mu_b_more", "mu_b_fall",
 * "e_b", "e_c" or "f_c"; the friction between two balls that slip at u m/s is mu_b + mu_b_more exp(-mu_b_fall
 * u). A new radius puts the balls that are there on the cloth again; those with a radius of their own keep
 * it. */
CAROM_API carom_status carom_scene_set_ball_param(carom_scene* scene, const char* name, double value);
CAROM_API carom_status carom_scene_get_ball_param(const carom_scene* scene, const char* name, double* value);

/* Adds a ball, or puts the one of this id elsewhere (a radius and mass of its own stay). The height of its
 * centre has to be its radius, its vertical velocity 0. Where balls overlap, carom_simulate says so. */
CAROM_API carom_status carom_scene_set_ball(carom_scene* scene, const char* id, const double rvw[9]);

typedef struct carom_cue {
    double speed;         /* of the cue [m/s] */
    double aim_deg;       /* 0 = +x, 90 = +y */
    double elevation_deg; /* of the butt */
    double side, height;  /* offset in ball radii: left +, up +; together at most 0.5 */
    double mass;          /* [kg] */
    double end_mass;      /* of its end, which gives way sideways [kg]; 0 for none */
} carom_cue;

/* Fills in the defaults of a scene file: 9 m/s along +y, a little above the centre, 0.567 kg, end mass
 * 0.00567 kg. */
CAROM_API void carom_cue_init(carom_cue* cue);

/* The ball of this id is struck at the start; it has to be at rest. NULL for `cue` takes the cue away. */
CAROM_API carom_status carom_scene_set_cue(carom_scene* scene, const char* id, const carom_cue* cue);

/* The scene as a scene file. Returns its length; writes up to `size` bytes, the last of them 0. `text` may be
 * NULL where `size` is 0. (size_t)-1 on failure. */
CAROM_API size_t carom_scene_text(const carom_scene* scene, char* text, size_t size);

/* ---- Shots ---- */

typedef struct carom_record carom_record;

/* Validates the scene and runs it until everything rests or `until` seconds are over (a negative number: the
 * scene's own end). On failure *record is NULL. */
CAROM_API carom_status carom_simulate(const carom_scene* scene, double until, carom_record** record);
CAROM_API void carom_record_free(carom_record* record); /* NULL is allowed */

CAROM_API double carom_record_duration(const carom_record* record); /* [s] */
CAROM_API size_t carom_record_ball_count(const carom_record* record);
CAROM_API size_t carom_record_event_count(const carom_record* record);

/* Id of a ball, by its number from 0; NULL for a number that is not there. Lives as long as the record. */
CAROM_API const char* carom_record_ball_id(const carom_record* record, size_t ball);

typedef struct carom_event {
    double time;      /* [s] */
    const char* type; /* "ball_ball", "ball_cushion", "slide_roll", ...: docs/scene_format.md names the balls
                         and parts */
    const char* a;    /* id of the ball */
    char b[72];       /* id of the other ball, cushion, jaw or pocket; "" if there is none */
} carom_event;

/* Event 0, 1, ... in the order of time. */
CAROM_API carom_status carom_record_event(const carom_record* record, size_t index, carom_event* event);

/* State of a ball at time t (before the start: at the start; past the end: at the end). `state` gets
 * "stationary", "spinning", "sliding", "rolling" or "pocketed", or is NULL. */
CAROM_API carom_status carom_record_state(const carom_record* record, size_t ball, double t, double rvw[9],
                                          const char** state);

/* Hash of all bits of the record, 16 hexadecimal digits and a 0. */
CAROM_API carom_status carom_record_hash(const carom_record* record, char hash[17]);

#ifdef __cplusplus
}
#endif

#endif
