/* The C interface of carom: impacts of two balls, batches of such impacts, and whole shots.
 *
 * Units are SI; the frame is right-handed, z up from the cloth, x along the short side of the table, y along
 * the long side, the origin where two nose lines meet. The state of a ball is nine doubles, row by row:
 * position [m], velocity [m/s], angular velocity [rad/s] ("rvw", a 3 x 3 array in other programs).
 *
 * Functions that can fail return a carom_status; after a failure, carom_last_error() says what is wrong and
 * what to do. The library prints nothing, does not abort, and throws no exceptions. Any function may be
 * called from any thread. A scene may be changed by one thread at a time; a record may be read by several
 * threads. Every pointer must be valid and not NULL, unless the function's comment allows NULL.
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

/* ---- Scenes ---- */

typedef struct carom_scene carom_scene;

/* Reads a scene from a file or from its text (docs/reference/scene_format.md); messages use `name` as the
 * file name. On failure *scene is NULL. */
CAROM_API carom_status carom_scene_read(const char* path, carom_scene** scene);
CAROM_API carom_status carom_scene_parse(const char* text, const char* name, carom_scene** scene);

/* Creates a scene without balls on it. table: "nine_foot", ... (docs/reference/scene_format.md), or "" for an
 * unbounded cloth. balls: "pool", "snooker" or "carom", with the cushion model of their game, or these
 * with "_classic" appended. */
CAROM_API carom_status carom_scene_create(const char* table, const char* balls, carom_scene** scene);
CAROM_API void carom_scene_free(carom_scene* scene); /* NULL is allowed */

/* One parameter of the balls: "radius", "mass", "mu_s", "mu_r", "mu_sp", "mu_b", "mu_b_more", "mu_b_fall",
 * "e_b", "e_c", "e_c_fall", "e_c_above", "f_c", "f_c_more", "f_c_fall", "e_t", "e_t_more", "e_t_fall" or
 * "e_h". The friction between two balls that slip at u m/s is mu_b + mu_b_more exp(-mu_b_fall u), that of a
 * cushion f_c + f_c_more exp(-f_c_fall u), and its restitution at v m/s is e_c - e_c_fall max(0, v -
 * e_c_above); setting mu_b, f_c or e_c sets the other two to 0. A new radius also changes the heights of the
 * existing balls; balls with their own radius keep it.
 */
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

/* The cue strikes the ball with this id at the start; the ball must be at rest. NULL for `cue` removes the
 * cue. */
CAROM_API carom_status carom_scene_set_cue(carom_scene* scene, const char* id, const carom_cue* cue);

/* The scene as the text of a scene file. Returns its length without the final 0, or (size_t)-1 on failure.
 * Writes up to `size` bytes including the final 0. `text` may be NULL if `size` is 0. */
CAROM_API size_t carom_scene_text(const carom_scene* scene, char* text, size_t size);

/* ---- Shots ---- */

typedef struct carom_record carom_record;

/* Validates the scene and simulates it until everything is at rest or the time is `until` [s] (negative: the
 * end that the scene defines). On failure *record is NULL. */
CAROM_API carom_status carom_simulate(const carom_scene* scene, double until, carom_record** record);
CAROM_API void carom_record_free(carom_record* record); /* NULL is allowed */

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

/* A new scene for the next shot: the record's scene with its balls in their final states, without pocketed
 * balls and without the cue. On failure *scene is NULL. */
CAROM_API carom_status carom_scene_from_record(const carom_record* record, carom_scene** scene);

/* The same with the next strike, validated: the cue strikes the ball with this id. Returns
 * CAROM_BAD_SCENE if that ball has fallen or has left the table, or is not at rest. */
CAROM_API carom_status carom_next_scene(const carom_record* record, const char* id, const carom_cue* cue,
                                        carom_scene** scene);

/* ---- Games ---- */

typedef enum carom_game {
    CAROM_EIGHT_BALL = 0,    /* World Pool-Billiard Association */
    CAROM_NINE_BALL = 1,     /* the same */
    CAROM_THREE_CUSHION = 2, /* Union Mondiale de Billard */
    CAROM_SNOOKER = 3,       /* World Professional Billiards and Snooker Association */
    CAROM_SUM_TO_THREE = 4,
    CAROM_TEN_BALL = 5,
    CAROM_STRAIGHT_POOL = 6,
    CAROM_FREE_PYRAMID = 7,
    CAROM_STRAIGHT_RAIL = 8,
    CAROM_ONE_CUSHION = 9,
    CAROM_FOUR_BALL = 10
} carom_game;

/* Where the cue ball may be placed: not at all, anywhere, behind the head string, in the D. */
typedef enum carom_in_hand {
    CAROM_NOT_IN_HAND = 0,
    CAROM_ANYWHERE = 1,
    CAROM_HEAD_STRING = 2,
    CAROM_IN_THE_D = 3
} carom_in_hand;

/* Everything a game remembers between two shots, besides the positions of the balls. Players are 0 and 1. */
typedef struct carom_game_state {
    int32_t game;    /* a carom_game, plus 256 times the options that carom_game_rule sets */
    int32_t turn;    /* whose shot it is */
    int32_t opening; /* 1: the break, or the first shot of a carom game */
    int32_t in_hand; /* a carom_in_hand */
    int32_t points[2];
    int32_t target;       /* points that win a carom game; 0: no end */
    int32_t over;         /* 1: the game is over */
    int32_t winner;       /* -1: none, or not yet */
    int32_t group[2];     /* eight-ball, of each player: 0 open, 1 solids, 2 stripes */
    int32_t may_push_out; /* nine-ball: 1 for the shot after the break */
    int32_t fouls[2];     /* nine-ball: consecutive fouls of each player */
    int32_t on;           /* snooker: 0 any colour, 1 red, 2 yellow, ..., 7 black */
    int32_t free_ball;    /* snooker: 1: any ball may be nominated as the ball on */
} carom_game_state;

/* The state before the first shot; `first` is the player who begins. */
CAROM_API carom_status carom_game_new(carom_game game, int first, int target, carom_game_state* state);

/* Chooses an option of the game's rules, such as "call=eight"; `carom describe games` lists them. Fails with
 * a message that lists the keys or values, if the game has no such option. */
CAROM_API carom_status carom_game_rule(carom_game_state* state, const char* option);

/* The rules of the next shot for `count` balls, named by their ids: `strike`, `first` and `callable` receive
 * 1 or 0 for each: whether the ball may be struck, may be hit first by the cue ball, and may be called. Each
 * of them may be NULL. */
CAROM_API carom_status carom_legal(const carom_game_state* state, size_t count, const char* const* ids,
                                   uint8_t* strike, uint8_t* first, uint8_t* callable);
/* The same for the balls of a scene, in its order. While the cue ball is in hand behind the head string, a
 * ball behind it may not be hit first, unless all are there. */
CAROM_API carom_status carom_legal_on(const carom_game_state* state, const carom_scene* scene,
                                      uint8_t* strike, uint8_t* first, uint8_t* callable);

/* An announcement before a shot. A text that is NULL announces nothing. */
typedef struct carom_call {
    const char* ball;   /* eight-ball: the called ball; snooker: the nominated colour or free ball */
    const char* pocket; /* eight-ball: "p1", ... */
    int32_t safety;     /* eight-ball: 1: the turn ends whatever falls */
    int32_t push_out;   /* nine-ball: 1 for a push out */
} carom_call;

typedef struct carom_verdict carom_verdict;

/* Judges a shot; `state` is the one before it. `call` may be NULL. The call fails, and *verdict is NULL, if
 * the record does not end at rest, has no cue strike or lacks the game's balls, or if the game is over. */
CAROM_API carom_status carom_judge(const carom_game_state* state, const carom_record* record,
                                   const carom_call* call, carom_verdict** verdict);
CAROM_API void carom_verdict_free(carom_verdict* verdict); /* NULL is allowed */

/* A foul and the rule that it breaks ("WPA 6.1"); NULL if the index is out of range. Valid until the program
 * ends. */
CAROM_API size_t carom_verdict_foul_count(const carom_verdict* verdict);
CAROM_API const char* carom_verdict_foul(const carom_verdict* verdict, size_t index);
CAROM_API const char* carom_verdict_rule(const carom_verdict* verdict, size_t index);

CAROM_API int carom_verdict_points(const carom_verdict* verdict); /* scored by the shot */
CAROM_API int carom_verdict_penalty(
    const carom_verdict* verdict); /* snooker: points that the other player gets */
/* The player who chooses among the options; -1 if there is only one, or if lots decide. */
CAROM_API int carom_verdict_chooser(const carom_verdict* verdict);

/* A possible continuation of the game; a verdict has at least one. The first one applies unless the chooser
 * picks another. */
typedef struct carom_option {
    const char*
        decision; /* "play on", "take in hand", "pass back", "rerack", ...; valid until the program ends */
    carom_game_state state; /* of the next shot */
    int32_t rerack;         /* 1: the balls are racked again */
    size_t respots;         /* number of balls that are respotted */
} carom_option;
CAROM_API size_t carom_verdict_option_count(const carom_verdict* verdict);
CAROM_API carom_status carom_verdict_option(const carom_verdict* verdict, size_t index, carom_option* option);
/* A respotted ball: its id, valid as long as the verdict exists, and its place [m]. */
CAROM_API carom_status carom_verdict_respot(const carom_verdict* verdict, size_t option, size_t index,
                                            const char** ball, double place[2]);

/* The next shot: pocketed balls are gone, respotted balls are back, and the cue ball of the state is placed
 * and struck. `place` is required if the cue ball is gone and allowed if it is in hand; otherwise it is NULL.
 * On failure *scene is NULL. */
CAROM_API carom_status carom_next_shot(const carom_record* record, const carom_verdict* verdict,
                                       size_t option, const carom_cue* cue, const double* place,
                                       carom_scene** scene);

/* The strike of a player who intends `cue`, with normal errors of these standard deviations: speed [m/s],
 * aim, elevation [degrees], side and height [ball radii]. The same seed and index give the same errors. The
 * result is always a legal strike. `out` may be `cue`. */
CAROM_API carom_status carom_noisy_cue(const carom_cue* cue, const double deviations[5], uint64_t seed,
                                       uint64_t index, carom_cue* out);
/* The deviations of "none", "fastfiz" or "ai3603" for a ball of this radius [m]. */
CAROM_API carom_status carom_noise(const char* name, double radius, double deviations[5]);

/* A player's advice on what to play: eight-ball, nine-ball, ten-ball. */
typedef struct carom_advice carom_advice;
/* One of its shots. Texts are valid as long as the advice exists. */
typedef struct carom_advised {
    const char* words; /* "3 into p6 (head-right corner pocket), cut 20 degrees right, hard, low" */
    const char* kind;  /* "pot", "combination", "bank", "kick", "safety", "push out", "break" */
    carom_cue cue;
    carom_call call;
    int32_t placed;  /* 1: the cue ball is in hand, and belongs at `place` */
    double place[2]; /* [m] */
    /* Shares of shots that the search has not used, each with its interval of 95 %: wins of the turn or the
     * game, and fouls. */
    double makes[3], fouls[3];
    double worth; /* mean value of the position that it leaves: 1 is a win, 0 a loss */
} carom_advised;

/* The best shots of different kind, ball or pocket, at most `best`, the best first. `skill`: "beginner",
 * "club", "league", "professional" or "machine". The balls of the scene must be at rest; its cue ball may be
 * missing while it is in hand. The same seed gives the same advice. On failure *advice is NULL. */
CAROM_API carom_status carom_advise(const carom_game_state* state, const carom_scene* scene,
                                    const char* skill, uint64_t seed, size_t best, carom_advice** advice);
CAROM_API void carom_advice_free(carom_advice* advice); /* NULL is allowed */
CAROM_API size_t carom_advice_count(const carom_advice* advice);
CAROM_API carom_status carom_advice_shot(const carom_advice* advice, size_t index, carom_advised* shot);

/* ---- Data for drawing and playing a game ----
 *
 * Texts in these structs are valid as long as the scene or record exists and is not changed. */

/* Sets a value by its key in scene files, as they write it: "physics.gravity" and "9.81", "physics.ball_ball"
 * and "\"two_step\"", "physics.tolerance" and "1e-8". The scene must be valid; on failure it is unchanged. */
CAROM_API carom_status carom_scene_set(carom_scene* scene, const char* key, const char* value);

/* The strike of the scene, and the id of the struck ball unless `ball` is NULL. Returns CAROM_BAD_ARGUMENT if
 * the scene has no cue. */
CAROM_API carom_status carom_scene_cue(const carom_scene* scene, carom_cue* cue, const char** ball);

/* The balls of a scene: id, state, and radius [m]; each of these may be NULL. */
CAROM_API size_t carom_scene_ball_count(const carom_scene* scene);
CAROM_API carom_status carom_scene_ball(const carom_scene* scene, size_t index, const char** id,
                                        double rvw[9], double* radius);

typedef struct carom_table {
    double corner[2];     /* of smallest x and y [m] */
    double width, length; /* between the nose lines, along x and y [m]; 0 for an endless cloth */
    size_t cushions, jaws, pockets;
} carom_table;
CAROM_API carom_status carom_scene_table(const carom_scene* scene, carom_table* table);

/* The partner of a ball in an event, and the parts of a table. */
typedef enum carom_partner {
    CAROM_NO_PARTNER = 0,
    CAROM_BALL = 1,
    CAROM_CUSHION = 2,
    CAROM_JAW = 3,
    CAROM_POCKET = 4
} carom_partner;

typedef struct carom_part {
    const char* id;          /* "c1", "j1", "p1", ...; round walls are jaws, "a1", ... */
    const char* name;        /* for people: "left rail, head half"; "" if it has none */
    double from[2], to[2];   /* [m] the ends of a cushion; of others both are the centre */
    double radius;           /* of a jaw or pocket [m]; 0 for a cushion */
    double height;           /* of the nose above the cloth [m]; 0 for a pocket */
    double from_deg, to_deg; /* of a round wall, counter-clockwise; 0 for others */
    int inside;              /* whether a round wall lies around the balls */
} carom_part;
CAROM_API carom_status carom_scene_part(const carom_scene* scene, carom_partner kind, size_t index,
                                        carom_part* part);

/* A place on the nose line of a rail, "head", "foot", "left" or "right": 0 to 4 diamonds along short rails
 * and 0 to 8 along long ones, from the table's corner. */
CAROM_API carom_status carom_scene_diamond(const carom_scene* scene, const char* rail, double number,
                                           double place[2]);
/* A spot: "head", "center", "foot", or a colour of snooker. */
CAROM_API carom_status carom_scene_spot(const carom_scene* scene, const char* name, double place[2]);

/* How every ball has turned since the start, at `count` times: `xyzw` receives count x balls x 4 numbers,
 * quaternions x, y, z, w from the ball's frame to the table's, in the order of carom_record_states. */
CAROM_API carom_status carom_record_orientations(const carom_record* record, size_t count,
                                                 const double* times, double* xyzw);

/* The types of events in the order of docs/reference/record_format.md. */
typedef enum carom_event_type {
    CAROM_CUE_STRIKE = 0,
    CAROM_BALL_BALL = 1,
    CAROM_BALL_CLUSTER = 2,
    CAROM_BALL_CUSHION = 3,
    CAROM_BALL_JAW = 4,
    CAROM_BALL_POCKET = 5,
    CAROM_SLIDE_ROLL = 6,
    CAROM_ROLL_SPIN = 7,
    CAROM_ROLL_STOP = 8,
    CAROM_SPIN_STOP = 9,
    CAROM_BALL_BALL_HOLD = 10,
    CAROM_BALL_BALL_RELEASE = 11,
    CAROM_BALL_CUSHION_HOLD = 12,
    CAROM_BALL_CUSHION_RELEASE = 13,
    CAROM_BALL_JAW_HOLD = 14,
    CAROM_BALL_JAW_RELEASE = 15,
    CAROM_BALL_EDGE = 16,
    CAROM_BALL_CLOTH = 17,
    CAROM_BALL_OUT = 18
} carom_event_type;

/* Details of an event beyond carom_event; NaN for those that its type does not have. */
typedef struct carom_event_details {
    double time;      /* [s] */
    int32_t type;     /* a carom_event_type */
    int32_t a;        /* index of the ball */
    int32_t partner;  /* a carom_partner: the kind of b */
    int32_t b;        /* index of the other ball or of the part, or -1 */
    double point[3];  /* contact point of ball a [m] */
    double normal[3]; /* unit vector along which ball a is pushed */
    double cut_deg;   /* between the velocity and the line of the impact */
    double closing;   /* speed along the normal [m/s] */
    double impulse;   /* that ball a received [N s] */
    double lost;      /* energy [J] */
    double diamond;   /* of a cushion, as in carom_scene_diamond */
} carom_event_details;
CAROM_API carom_status carom_record_event_details(const carom_record* record, size_t index,
                                                  carom_event_details* details);

/* A contact that pushed: the pair of an impact, or one contact of a cluster. */
typedef struct carom_hit {
    double time;     /* [s] of its first touch */
    double impulse;  /* along the normal [N s]; 0 unless it belongs to a cluster */
    int32_t event;   /* index of its event */
    int32_t a;       /* index of the ball */
    int32_t partner; /* a carom_partner: the kind of b */
    int32_t b;       /* index of the other ball or of the part; -1: the cloth */
} carom_hit;
/* Who pushed whom, in order of the events: `hits` receives carom_record_hit_count of them. */
CAROM_API size_t carom_record_hit_count(const carom_record* record);
CAROM_API carom_status carom_record_hits(const carom_record* record, carom_hit* hits);

/* Records as JSON, in files and as text (as carom_scene_text). A file contains no physics, so reading needs
 * the played scene, with the same balls. On failure *record is NULL. */
CAROM_API carom_status carom_record_write(const carom_record* record, const char* path);
CAROM_API size_t carom_record_text(const carom_record* record, char* text, size_t size);
CAROM_API carom_status carom_record_read(const char* path, const carom_scene* scene, carom_record** record);
CAROM_API carom_status carom_record_parse(const char* text, const carom_scene* scene, carom_record** record);

/* *allowed is 1 if the cue ball may be placed there [m] under this option of a verdict, otherwise 0. */
CAROM_API carom_status carom_may_place(const carom_record* record, const carom_verdict* verdict,
                                       size_t option, const double place[2], int32_t* allowed);

/* The straight paths of a ball into a pocket. `towards` is the unit vector in their middle, `width_deg` the
 * angle between the outermost ones, 0 if there is none; `distance` [m] is from the ball to where it falls.
 * `ghost` is the centre of the cue ball when it sends the ball there, without throw [m]. `in_the_way` is the
 * nearest ball on the middle path, or "". */
typedef struct carom_pocket_line {
    double towards[2], ghost[2];
    double width_deg, distance;
    char in_the_way[72];
} carom_pocket_line;
/* One for each pocket: `lines` receives carom_table.pockets of them. */
CAROM_API carom_status carom_pocket_lines(const carom_scene* scene, const char* ball, const char* cue_ball,
                                          carom_pocket_line* lines);

/* A strike that was played and succeeded, if `found` is 1; otherwise `why` states the reason. */
typedef struct carom_aim {
    int32_t found;
    carom_cue cue;
    double geometric_deg; /* carom_aim_pot: the aim without throw, squirt and swerve */
    double cut_deg;       /* carom_aim_pot: cut angle of that aim */
    char cushion[8];      /* carom_bank_routes: the cushion that the ball hits */
    char why[160];
} carom_aim;
/* The aim that pots a ball; `how` is the strike of `cue_ball`, its aim is ignored. */
CAROM_API carom_status carom_aim_pot(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                                     const char* ball, const char* pocket, carom_aim* aim);
/* Aims that pot it off one cushion: at most one per cushion. Writes up to `size` of them; *count receives
 * their number. */
CAROM_API carom_status carom_bank_routes(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                                         const char* ball, const char* pocket, size_t size, carom_aim* aims,
                                         size_t* count);

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
