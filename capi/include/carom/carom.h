/* The C interface of carom: impacts of two balls, batches of such impacts, and whole shots.
 *
 * Units are SI; the frame is right-handed, z up from the cloth, x along the short side of the table, y along
 * the long side, the origin where two nose lines meet. The state of a ball is nine doubles, row by row:
 * position [m], velocity [m/s], angular velocity [rad/s] ("rvw", a 3 x 3 array in other programs).
 *
 * Functions that can fail return a carom_status; after a failure carom_last_error() tells what is wrong and what to
 * do. The library prints nothing, does not abort, and throws no exceptions. Any function may be called from any
 * thread. A scene may be changed by one thread at a time; a record may be read by several threads. Every pointer must
 * be valid and not NULL, unless the comment of the function allows NULL.
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

/* The version of the library, such as "0.1.0"; CAROM_VERSION is the version of this header. */
CAROM_API const char* carom_version(void);

typedef enum carom_status {
    CAROM_OK = 0,
    CAROM_BAD_ARGUMENT = 1, /* an argument is invalid: NULL, an unknown name, or an index out of range */
    CAROM_BAD_SCENE = 2,    /* the scene, or the file to read it from, is invalid */
    CAROM_FAILED = 3,       /* the simulation cannot continue */
    CAROM_NO_MEMORY = 4,
    CAROM_INTERNAL = 5 /* a defect of the library */
} carom_status;

/* The message of the last failed call in this thread; "" if no call has failed. Valid until the next failed call in
 * this thread. */
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
    CAROM_IMPACT_NOT_APPROACHING = 1, /* not approaching: velocities unchanged */
    CAROM_IMPACT_BAD_STATE = 2,     /* not finite, or centres that coincide or differ in height: unchanged */
    CAROM_IMPACT_BAD_PARAMETER = 3, /* a parameter is out of range: unchanged */
    CAROM_IMPACT_STEP_LIMIT = 4     /* not solved within the step limit: unchanged */
} carom_impact_status;

/* Solves one impact of the model of Mathavan, Jackson and Parkin (2014) with an error of at most `tolerance` (1e-13
 * to 1e-1) times the approach speed. `out` may be `in`. Returns CAROM_BAD_ARGUMENT if a state, a parameter or the
 * tolerance is invalid. For balls that do not approach it returns CAROM_OK and the unchanged states. */
CAROM_API carom_status carom_collide_balls(const double in1[9], const double in2[9],
                                           const carom_impact_params* params, double tolerance,
                                           double out1[9], double out2[9]);

/* Solves `count` impacts, several times faster per impact. States are consecutive (count x 3 x 3). Parameters: one set
 * for all impacts (params_count = 1) or one for each (params_count = count). `status` receives count values of
 * carom_impact_status, or is NULL. If an impact cannot be computed, its states are left unchanged, the others are
 * solved, and the call returns CAROM_BAD_ARGUMENT. `out` may be `in`. The error bound is that of carom_collide_balls;
 * the results may differ from it within that bound. */
CAROM_API carom_status carom_collide_balls_batch(size_t count, const double* in1, const double* in2,
                                                 const carom_impact_params* params, size_t params_count,
                                                 double tolerance, double* out1, double* out2,
                                                 int32_t* status);

/* ---- Scenes ---- */

typedef struct carom_scene carom_scene;

/* Reads a scene from a file or from its text (docs/reference/scene_format.md); messages use `name` as the name of the file. On
 * failure *scene is NULL. */
CAROM_API carom_status carom_scene_read(const char* path, carom_scene** scene);
CAROM_API carom_status carom_scene_parse(const char* text, const char* name, carom_scene** scene);

/* Creates a scene without balls on it. table: "nine_foot", ... (docs/reference/scene_format.md), or "" for an
 * unbounded cloth. balls: "pool", "snooker" or "carom", with the cushion model of their game, or these with
 * "_classic" behind the name. */
CAROM_API carom_status carom_scene_create(const char* table, const char* balls, carom_scene** scene);
CAROM_API void carom_scene_free(carom_scene* scene); /* NULL is allowed */

/* One parameter of the balls: "radius", "mass", "mu_s", "mu_r", "mu_sp", "mu_b", "mu_b_more", "mu_b_fall", "e_b",
 * "e_c", "e_c_fall", "e_c_above", "f_c", "f_c_more" or "f_c_fall". The friction between two balls that slip at u m/s is
 * mu_b + mu_b_more exp(-mu_b_fall u), that of a cushion f_c + f_c_more exp(-f_c_fall u), and its restitution at v m/s is
 * e_c - e_c_fall max(0, v - e_c_above); setting mu_b, f_c or e_c sets the other two to 0. A new radius also changes the heights of the existing balls; balls with their own radius keep it. */
CAROM_API carom_status carom_scene_set_ball_param(carom_scene* scene, const char* name, double value);
CAROM_API carom_status carom_scene_get_ball_param(const carom_scene* scene, const char* name, double* value);

/* Adds a ball, or sets the state of the ball with this id, which keeps its own radius and mass. The height of its
 * centre must be its radius, its vertical velocity 0. carom_simulate reports balls that overlap. */
CAROM_API carom_status carom_scene_set_ball(carom_scene* scene, const char* id, const double rvw[9]);

typedef struct carom_cue {
    double speed;         /* of the cue [m/s] */
    double aim_deg;       /* 0 = +x, 90 = +y */
    double elevation_deg; /* of the butt */
    double side, height;  /* offset in ball radii: left +, up +; together at most 0.5 */
    double mass;          /* [kg] */
    double end_mass;      /* of its end, which gives way sideways [kg]; 0 for none */
    double restitution;   /* of the tip, 0 to 1; 1 loses nothing */
} carom_cue;

/* Sets the defaults of a scene file: 9 m/s along +y, slightly above the centre, 0.567 kg, end mass 0.00567 kg,
 * restitution 0.73. */
CAROM_API void carom_cue_init(carom_cue* cue);

/* The cue strikes the ball with this id at the start; the ball must be at rest. NULL for `cue` removes the cue. */
CAROM_API carom_status carom_scene_set_cue(carom_scene* scene, const char* id, const carom_cue* cue);

/* The scene as the text of a scene file. Returns its length without the final 0, or (size_t)-1 on failure. Writes up to
 * `size` bytes including the final 0. `text` may be NULL if `size` is 0. */
CAROM_API size_t carom_scene_text(const carom_scene* scene, char* text, size_t size);

/* ---- Shots ---- */

typedef struct carom_record carom_record;

/* Validates the scene and simulates it until everything is at rest or the time is `until` [s] (negative: the end that
 * the scene defines). On failure *record is NULL. */
CAROM_API carom_status carom_simulate(const carom_scene* scene, double until, carom_record** record);
CAROM_API void carom_record_free(carom_record* record); /* NULL is allowed */

CAROM_API double carom_record_duration(const carom_record* record); /* [s] */
CAROM_API size_t carom_record_ball_count(const carom_record* record);
CAROM_API size_t carom_record_event_count(const carom_record* record);

/* Id of a ball by its index from 0; NULL if the index is out of range. Valid as long as the record exists. */
CAROM_API const char* carom_record_ball_id(const carom_record* record, size_t ball);

/* The types of events are those of docs/reference/record_format.md; docs/reference/scene_format.md has the ids of balls and parts. */
typedef struct carom_event {
    double time;      /* [s] */
    const char* type; /* "ball_ball", "ball_cushion", "slide_roll", ... */
    const char* a;    /* id of the ball */
    char b[72];       /* id of the other ball, cushion, jaw or pocket; "" if there is none */
} carom_event;

/* Event 0, 1, ... in chronological order. */
CAROM_API carom_status carom_record_event(const carom_record* record, size_t index, carom_event* event);

/* State of a ball at time t [s]; before the start that of the start, after the end that of the end. `state` receives
 * "stationary", "spinning", "sliding", "rolling" or "pocketed", or is NULL. */
CAROM_API carom_status carom_record_state(const carom_record* record, size_t ball, double t, double rvw[9],
                                          const char** state);

/* Hash of all bits of the record: 16 hexadecimal digits and a final 0. */
CAROM_API carom_status carom_record_hash(const carom_record* record, char hash[17]);

#ifdef __cplusplus
}
#endif

#endif
