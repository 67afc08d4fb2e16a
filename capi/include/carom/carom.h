/* The C interface of carom: impacts of two balls, whole shots, games, and batches of shots.
 *
 * Units are SI; the frame is right-handed, z up from the cloth, x along the short side of the table, y along
 * the long side, the origin where two nose lines meet. The state of a ball is nine doubles, row by row:
 * position [m], velocity [m/s], angular velocity [rad/s] ("rvw", a 3 x 3 array in other programs).
 *
 * Functions that can fail return a carom_status. After a failure, carom_last_error() says what is wrong and
 * what to do; a function that makes an object then gives NULL. The library prints nothing, does not abort,
 * and throws no exceptions. Any function may be called from any thread. A scene may be changed by one thread
 * at a time; records and values never change. Every pointer must be valid and not NULL, unless the function's
 * comment allows NULL; every _free function does.
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

/* The message of the last failed call in this thread; "" if no call has failed. Valid until the next failed
 * call in this thread. */
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

/* Solves one impact in the model of Mathavan, Jackson and Parkin (2014) with an error of at most `tolerance`
 * (1e-13 to 1e-1) times the approach speed. Outputs may be inputs. Returns CAROM_BAD_ARGUMENT if a state, a
 * parameter or the tolerance is invalid. For balls that do not approach it returns CAROM_OK and the unchanged
 * states. */
CAROM_API carom_status carom_collide_balls(const double in1[9], const double in2[9],
                                           const carom_impact_params* params, double tolerance,
                                           double out1[9], double out2[9]);

/* Solves `count` impacts, several times faster per impact than carom_collide_balls. States are consecutive
 * (count x 3 x 3). Parameters: one set for all impacts (params_count = 1) or one for each (params_count =
 * count). `status` receives count values of carom_impact_status, or is NULL. If an impact cannot be computed,
 * its states are left unchanged, the others are solved, and the call returns CAROM_BAD_ARGUMENT. `out` may be
 * `in`. The error bound is that of carom_collide_balls; the results may differ from it within that bound. */
CAROM_API carom_status carom_collide_balls_batch(size_t count, const double* in1, const double* in2,
                                                 const carom_impact_params* params, size_t params_count,
                                                 double tolerance, double* out1, double* out2,
                                                 int32_t* status);

/* ---- Values ----
 *
 * The state of a game, a verdict, advice, the plan of a scene: a value is a tree of objects, lists, texts and
 * numbers. docs/reference/types.md lists the types and their keys, the same as in JSON, Python and
 * JavaScript. A path names a part: "turn", "options[0].state.in_hand", "[2].cue"; "" is the whole. If there
 * is no such part, the message lists the parts. */
typedef struct carom_value carom_value;
CAROM_API carom_status carom_value_parse(const char* json, carom_value** value);
/* The value as JSON; sizes as in carom_scene_text. */
CAROM_API size_t carom_value_json(const carom_value* value, char* text, size_t size);
CAROM_API void carom_value_free(carom_value* value);

/* A number; 1 or 0 for a truth, NaN for null. */
CAROM_API carom_status carom_value_number(const carom_value* value, const char* path, double* number);
/* A text, valid as long as the value exists. */
CAROM_API carom_status carom_value_text(const carom_value* value, const char* path, const char** text);
/* The number of items in a list; 0 if there is none. */
CAROM_API size_t carom_value_count(const carom_value* value, const char* path);
/* A copy of a part. */
CAROM_API carom_status carom_value_part(const carom_value* value, const char* path, carom_value** part);

/* ---- Scenes ---- */

typedef struct carom_scene carom_scene;
/* Reads a scene from a file or from its text (docs/reference/scene_format.md); messages use `name` as the
 * file name. */
CAROM_API carom_status carom_scene_read(const char* path, carom_scene** scene);
CAROM_API carom_status carom_scene_parse(const char* text, const char* name, carom_scene** scene);

/* Creates a scene without balls on it. table: "nine_foot", ..., or "" for an unbounded cloth. balls: "pool",
 * "snooker" or "carom", with the cushion model of their game, or these with "_classic" appended. */
CAROM_API carom_status carom_scene_create(const char* table, const char* balls, carom_scene** scene);
CAROM_API void carom_scene_free(carom_scene* scene);
/* Sets a value by its key in scene files, as they write it: "physics.gravity" and "9.81", "physics.ball_ball"
 * and "\"two_step\"", "physics.tolerance" and "1e-8". The scene must be valid; on failure it is unchanged. */
CAROM_API carom_status carom_scene_set(carom_scene* scene, const char* key, const char* value);

/* One parameter of the balls, by its key in [balls]. The friction between two balls that slip at u m/s is
 * mu_b + mu_b_more exp(-mu_b_fall u), that of a cushion f_c + f_c_more exp(-f_c_fall u), and its restitution
 * at v m/s is e_c - e_c_fall max(0, v - e_c_above); setting mu_b, f_c or e_c sets the other two to 0. A new
 * radius also changes the heights of the existing balls; balls with their own radius keep it. */
CAROM_API carom_status carom_scene_set_ball_param(carom_scene* scene, const char* name, double value);
CAROM_API carom_status carom_scene_get_ball_param(const carom_scene* scene, const char* name, double* value);

/* Adds a ball, or sets the state of the ball with this id, which keeps its own radius and mass. The height of
 * its centre must be its radius, and its vertical velocity must be 0. carom_simulate reports balls that
 * overlap. */
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

/* Sets the defaults of a scene file: 9 m/s along +y, slightly above the centre, 0.567 kg, end mass 0.00567
 * kg, restitution 0.73. */
CAROM_API void carom_cue_init(carom_cue* cue);
/* The Cue at this path of a value: "[0].cue" of advice, "cue" of a plan. */
CAROM_API carom_status carom_value_cue(const carom_value* value, const char* path, carom_cue* cue);

/* The cue strikes the ball with this id at the start; the ball must be at rest. NULL for `cue` removes the
 * cue. */
CAROM_API carom_status carom_scene_set_cue(carom_scene* scene, const char* id, const carom_cue* cue);

/* The scene as the text of a scene file. Returns its length without the final 0, or (size_t)-1 on failure.
 * Writes up to `size` bytes including the final 0. `text` may be NULL if `size` is 0. */
CAROM_API size_t carom_scene_text(const carom_scene* scene, char* text, size_t size);

/* The contents of a scene: {"table": {"width", "length", "corner", "cushions", "jaws", "pockets", ...},
 * "balls": [{"id", "position", "velocity", "spin", "radius", "mass"}, ...], "cue": a Cue, or null}. The parts
 * of the table have the keys of scene files, an id and a name for people. */
CAROM_API carom_status carom_scene_plan(const carom_scene* scene, carom_value** plan);
/* A place on the nose line of a rail, "head", "foot", "left" or "right": 0 to 4 diamonds along short rails
 * and 0 to 8 along long ones, from the table's corner. */
CAROM_API carom_status carom_scene_diamond(const carom_scene* scene, const char* rail, double number,
                                           double place[2]);
/* A spot: "head", "center", "foot", or a colour of snooker. */
CAROM_API carom_status carom_scene_spot(const carom_scene* scene, const char* name, double place[2]);

/* ---- Shots ---- */

typedef struct carom_record carom_record;
/* Validates the scene and simulates it until everything is at rest or the time is `until` [s] (negative: the
 * end that the scene defines). */
CAROM_API carom_status carom_simulate(const carom_scene* scene, double until, carom_record** record);
CAROM_API void carom_record_free(carom_record* record);
CAROM_API double carom_record_duration(const carom_record* record); /* [s] */
CAROM_API size_t carom_record_ball_count(const carom_record* record);
CAROM_API size_t carom_record_event_count(const carom_record* record);

/* Id of a ball by its index from 0; NULL if the index is out of range. Valid as long as the record exists. */
CAROM_API const char* carom_record_ball_id(const carom_record* record, size_t ball);

/* docs/reference/record_format.md lists the types of events, docs/reference/scene_format.md the ids of balls
 * and parts. */
typedef struct carom_event {
    double time;      /* [s] */
    const char* type; /* "ball_ball", "ball_cushion", "slide_roll", ... */
    const char* a;    /* id of the ball */
    char b[72];       /* id of the other ball, cushion, jaw or pocket; "" if there is none */
} carom_event;

/* Event 0, 1, ... in chronological order. */
CAROM_API carom_status carom_record_event(const carom_record* record, size_t index, carom_event* event);

/* State of a ball at time t [s]. Before the start it is the initial state, after the end the final one.
 * `state` receives "stationary", "spinning", "sliding", "rolling", "pocketed", "falling" (over a pocket),
 * "airborne", "out" or "colliding" (in a cluster), or is NULL. */
CAROM_API carom_status carom_record_state(const carom_record* record, size_t ball, double t, double rvw[9],
                                          const char** state);

/* Hash of all bits of the record: 16 hexadecimal digits and a final 0. */
CAROM_API carom_status carom_record_hash(const carom_record* record, char hash[17]);

/* Checks the laws of mechanics, as `carom simulate --verify` does; the record may be another program's
 * (carom_record_read). Writes the first law that is broken, up to `size` bytes with the final 0, and returns
 * the length of the text: 0 if every law holds, (size_t)-1 on failure (a record of another scene). */
CAROM_API size_t carom_record_verify(const carom_record* record, char* broken, size_t size);

/* The motion of a ball between two events that involve it, in closed form. At u = t - start,
 * 0 <= u <= duration, its centre is at r + u (v + u a / 2). Its velocity is v + u a, or v (1 - u / duration)
 * if it rolls and is not held. Its angular velocity is w + u dw in x and y, or that of rolling if it rolls;
 * w_z moves towards 0 by spin_decay per second and stays there. */
typedef struct carom_segment {
    double start;       /* [s] since the start of the shot */
    double duration;    /* until the ball's own next transition [s]; infinite if there is none */
    double r[3], v[3];  /* centre [m] and velocity [m/s] at the start */
    double w[3];        /* angular velocity at the start [rad/s] */
    double a[3], dw[3]; /* constant rates of v and w [m/s^2], [rad/s^2]; dw[2] is 0, and so is a[2] unless the
                           ball falls or flies */
    double spin_decay;  /* decrease of |w_z| per second [rad/s^2], at least 0 */
    int32_t state;      /* a carom_motion_state */
    int32_t held;       /* 1 in a resting contact, otherwise 0 */
} carom_segment;

typedef enum carom_motion_state {
    CAROM_STATIONARY = 0,
    CAROM_SPINNING = 1,
    CAROM_SLIDING = 2,
    CAROM_ROLLING = 3,
    CAROM_POCKETED = 4,
    CAROM_FALLING = 5,
    CAROM_AIRBORNE = 6,
    CAROM_OUT = 7,      /* off the table */
    CAROM_COLLIDING = 8 /* in a cluster: it moves straight to where it is when the contacts are over */
} carom_motion_state;

/* The segments of a ball in the order of their starts; if two have the same start, the later one applies.
 * `segments` receives carom_record_segment_count of them, which is 0 if there is no such ball. A game can
 * draw every frame from these without another call. */
CAROM_API size_t carom_record_segment_count(const carom_record* record, size_t ball);
CAROM_API carom_status carom_record_segments(const carom_record* record, size_t ball,
                                             carom_segment* segments);

/* States of all balls at `count` times: `rvw` receives count x balls x 9 numbers, ball after ball at the
 * first time, then at the second. `states` receives count x balls values of carom_motion_state, or is NULL.
 * Times before the start and after the end are treated as in carom_record_state. */
CAROM_API carom_status carom_record_states(const carom_record* record, size_t count, const double* times,
                                           double* rvw, uint8_t* states);

/* How every ball has turned since the start, at `count` times: `xyzw` receives count x balls x 4 numbers,
 * quaternions x, y, z, w from the ball's frame to the table's, in the order of carom_record_states. */
CAROM_API carom_status carom_record_orientations(const carom_record* record, size_t count,
                                                 const double* times, double* xyzw);

/* Numbers of every event: `numbers` receives carom_record_event_count x columns of them, event after event.
 * `carom describe events` lists the names of columns, such as "a_vx", "point_x", "closing", "impulse" and
 * "lost". NaN: an event has no such number. */
CAROM_API carom_status carom_record_events(const carom_record* record, size_t columns,
                                           const char* const* names, double* numbers);

/* A contact that pushed: the pair of an impact, or one contact of a cluster. */
typedef struct carom_hit {
    double time;      /* [s] of its first touch */
    double impulse;   /* along the normal [N s]; 0 unless it belongs to a cluster */
    int32_t event;    /* index of its event */
    int32_t a;        /* index of the ball */
    const char* with; /* "ball", "cushion", "jaw" or "cloth": the kind of b */
    int32_t b;        /* index of the other ball or of the part; -1: the cloth */
} carom_hit;
/* Who pushed whom, in order of the events: `hits` receives carom_record_hit_count of them. */
CAROM_API size_t carom_record_hit_count(const carom_record* record);
CAROM_API carom_status carom_record_hits(const carom_record* record, carom_hit* hits);

/* Records as JSON, in files and as text (as carom_scene_text). A file contains no physics, so reading needs
 * the played scene, with the same balls. */
CAROM_API carom_status carom_record_write(const carom_record* record, const char* path);
CAROM_API size_t carom_record_text(const carom_record* record, char* text, size_t size);
CAROM_API carom_status carom_record_read(const char* path, const carom_scene* scene, carom_record** record);
CAROM_API carom_status carom_record_parse(const char* text, const carom_scene* scene, carom_record** record);

/* A new scene for the next shot: the record's scene with its balls in their final states, without pocketed
 * balls and without the cue. */
CAROM_API carom_status carom_scene_from_record(const carom_record* record, carom_scene** scene);
/* The same with the next strike, validated: the cue strikes the ball with this id. Returns
 * CAROM_BAD_SCENE if that ball has fallen or has left the table, or is not at rest. */
CAROM_API carom_status carom_next_scene(const carom_record* record, const char* id, const carom_cue* cue,
                                        carom_scene** scene);

/* ---- Games ----
 *
 * Rules, aiming aids and a player. docs/reference/types.md has the types, such as State. */

/* All games: a list of GameInfo, with their names, books and options. */
CAROM_API carom_status carom_games(carom_value** games);

/* The State before the first shot. options: JSON with the keys of a State that are not defaults, or NULL:
 * {"turn": 1, "target": 8, "rules": ["call=eight"]}. */
CAROM_API carom_status carom_game_new(const char* game, const char* options, carom_value** state);

/* The Legal choices for the next shot with the balls of a scene. */
CAROM_API carom_status carom_legal(const carom_value* state, const carom_scene* scene, carom_value** legal);

/* The Verdict on a shot; `state` is the one before it. call: JSON of a Call, or NULL: {"ball": "8", "pocket":
 * "p1"}. The call fails if the record does not end at rest, has no cue strike or lacks the game's balls, or
 * if the game is over. */
CAROM_API carom_status carom_judge(const carom_value* state, const carom_record* record, const char* call,
                                   carom_value** verdict);
/* *allowed is 1 if the cue ball may be placed there [m] under this option of a verdict, otherwise 0. */
CAROM_API carom_status carom_may_place(const carom_record* record, const carom_value* verdict, size_t option,
                                       const double place[2], int32_t* allowed);
/* The next shot: pocketed balls are gone, respotted balls are back, and the cue ball of the state is placed
 * and struck. `place` is required if the cue ball is gone and allowed if it is in hand; otherwise it is
 * NULL. */
CAROM_API carom_status carom_next_shot(const carom_record* record, const carom_value* verdict, size_t option,
                                       const carom_cue* cue, const double* place, carom_scene** scene);

/* One PocketLine for each pocket of the table: the paths of a ball, which `cue_ball` does not block. */
CAROM_API carom_status carom_pocket_lines(const carom_scene* scene, const char* ball, const char* cue_ball,
                                          carom_value** lines);
/* The Aim that pots a ball; `how` is the strike of `cue_ball`, its aim is ignored. */
CAROM_API carom_status carom_aim_pot(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                                     const char* ball, const char* pocket, carom_value** aim);
/* A list of Aims that pot it off one cushion, at most one per cushion. */
CAROM_API carom_status carom_bank_routes(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                                         const char* ball, const char* pocket, carom_value** aims);

/* The Noise of "none", "fastfiz" or "ai3603" for a ball of this radius [m]. */
CAROM_API carom_status carom_noise(const char* name, double radius, carom_value** noise);
/* The strike of a player who intends `cue`. The same seed and index give the same errors, and the result is
 * always a legal strike. `out` may be `cue`. */
CAROM_API carom_status carom_noisy_cue(const carom_cue* cue, const carom_value* noise, uint64_t seed,
                                       uint64_t index, carom_cue* out);

/* A list of Advice: the best shots of different kind, ball or pocket, at most `best`, the best first. For
 * eight-ball, nine-ball and ten-ball. `skill`: "beginner", "club", "league", "professional" or "machine". The
 * balls of the scene must be at rest; its cue ball may be missing while it is in hand. The same seed gives
 * the same advice. */
CAROM_API carom_status carom_advise(const carom_value* state, const carom_scene* scene, const char* skill,
                                    uint64_t seed, size_t best, carom_value** advice);

/* ---- Many shots ---- */

typedef struct carom_batch carom_batch;

typedef enum carom_shot_status {
    CAROM_SHOT_AT_REST = 0,
    CAROM_SHOT_TIME = 1,    /* ended at the time limit */
    CAROM_SHOT_EVENTS = 2,  /* ended at the event limit */
    CAROM_SHOT_ENDLESS = 3, /* nothing stops the balls, and nothing more happens to them */
    CAROM_SHOT_INVALID = 4, /* no result: these values make no valid scene */
    CAROM_SHOT_FAILED = 5   /* no result: the simulation could not continue */
} carom_shot_status;

/* Plays `shots` shots of one scene that differ in the numbers of some keys, such as "cue.speed",
 * "cue.aim_deg", "cue.offset.side", "ball.1.position.x", "ball.1.velocity.y", "balls.mu_b"
 * (docs/guide/sweep.md; the numbers of [cue], [balls], [[ball]], [physics], [stop] and of the parts of the
 * table). `values` contains key_count x shots numbers: all of the first key, then all of the second. Every
 * shot has the results of carom_simulate, bit for bit, whatever the number of threads (0: one for each core).
 * A shot that is invalid or fails has its status, the others are played, and the call returns CAROM_OK.
 * `hashes`: 1 if "hash" is wanted, otherwise 0. `until` as in carom_simulate. On failure (an
 * unknown key) *batch is NULL. `scene` need not be valid before its numbers are set. */
CAROM_API carom_status carom_simulate_many(const carom_scene* scene, size_t shots, size_t key_count,
                                           const char* const* keys, const double* values, double until,
                                           int threads, int hashes, carom_batch** batch);
CAROM_API void carom_batch_free(carom_batch* batch); /* NULL is allowed */

CAROM_API size_t carom_batch_shot_count(const carom_batch* batch);
CAROM_API size_t carom_batch_ball_count(const carom_batch* batch);

typedef enum carom_type {
    CAROM_UINT8 = 0,
    CAROM_INT32 = 1,
    CAROM_INT64 = 2,
    CAROM_UINT64 = 3,
    CAROM_FLOAT64 = 4 /* double */
} carom_type;

/* An array of outcomes by its name: "status" (a carom_shot_status), "duration", "events", "xy", ...;
 * docs/reference/types.md lists them. It contains shot_count x *each numbers of the type *type, the numbers
 * of the first shot first, and is valid as long as the batch exists. `type` and `each` may be NULL. NULL,
 * with carom_last_error, for an unknown name, and for "hash" unless it was requested. */
CAROM_API const void* carom_batch_column(const carom_batch* batch, const char* name, carom_type* type,
                                         size_t* each);

/* Why a shot has no result; "" if it has one. Valid as long as the batch exists. */
CAROM_API const char* carom_batch_message(const carom_batch* batch, size_t shot);

#ifdef __cplusplus
}
#endif

#endif
