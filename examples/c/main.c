/* The C interface: one impact, a batch of them, and a shot.
 *   cc main.c $(pkg-config --cflags --libs carom) -o shot && ./shot
 */
#include <stdio.h>
#include <stdlib.h>

#include "carom/carom.h"

enum { kImpacts = 1000 };

static void check(carom_status status) {
    if (status == CAROM_OK) return;
    fprintf(stderr, "%s\n", carom_last_error());
    exit(1);
}

/* Half-ball hits, each a millimetre per second faster than the one before. */
static void impacts(void) {
    const carom_impact_params params = {
        .R = 0.028575, .m = 0.17, .mu_s1 = 0.2, .mu_s2 = 0.2, .mu_b = 0.05, .e_b = 0.95};
    static double cue[kImpacts][9], object[kImpacts][9];
    for (int i = 0; i < kImpacts; ++i) {
        const double cue_state[9] = {0, 0, 0.028575, 0, 1.0 + 0.001 * i, 0, -35.0, 0, 0};
        const double object_state[9] = {0.028575, 0.0494933, 0.028575};
        for (int k = 0; k < 9; ++k) {
            cue[i][k] = cue_state[k];
            object[i][k] = object_state[k];
        }
    }
    double after1[9], after2[9];
    check(carom_collide_balls(cue[0], object[0], &params, 1e-6, after1, after2));
    printf("object ball leaves with (%.6f, %.6f) m/s\n", after2[3], after2[4]);
    check(carom_collide_balls_batch(kImpacts, cue[0], object[0], &params, 1, 1e-6, cue[0], object[0], NULL));
    printf("the last of %d with (%.6f, %.6f) m/s\n", kImpacts, object[kImpacts - 1][3],
           object[kImpacts - 1][4]);
}

static void shot(void) {
    carom_scene* scene;
    carom_record* record;
    carom_cue cue;
    double radius;
    check(carom_scene_create("nine_foot", "pool", &scene));
    check(carom_scene_get_ball_param(scene, "radius", &radius));
    check(carom_scene_set_ball(scene, "cue", (const double[9]){0.635, 0.60, radius}));
    check(carom_scene_set_ball(scene, "1", (const double[9]){0.65, 1.40, radius}));
    carom_cue_init(&cue);
    cue.speed = 3.0;
    cue.aim_deg = 90.0;
    cue.side = 0.1;
    cue.height = 0.0;
    check(carom_scene_set_cue(scene, "cue", &cue));
    check(carom_simulate(scene, -1.0, &record));
    for (size_t i = 0; i < carom_record_event_count(record); ++i) {
        carom_event event;
        check(carom_record_event(record, i, &event));
        printf("%9.6f s  %-14s %s %s\n", event.time, event.type, event.a, event.b);
    }
    carom_record_free(record);

    /* An error is a status and a message. */
    check(carom_scene_set_ball(scene, "1", (const double[9]){0.635, 0.61, radius}));
    if (carom_simulate(scene, -1.0, &record) == CAROM_BAD_SCENE) printf("refused: %s\n", carom_last_error());
    carom_scene_free(scene);
}

int main(void) {
    printf("carom %s\n", carom_version());
    impacts();
    shot();
    return 0;
}
