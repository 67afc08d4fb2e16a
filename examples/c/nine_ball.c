/* A game loop: two players play nine-ball, and the table is drawn in text once a second.
 *   cc nine_ball.c $(pkg-config --cflags --libs carom) -lm -o nine_ball
 *   ./nine_ball scenes/nine_ball_break.toml
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "carom/carom.h"

static void check(carom_status status) {
    if (status == CAROM_OK) return;
    fprintf(stderr, "%s\n", carom_last_error());
    exit(1);
}

/* The table lies on its side: y goes to the right. */
static void draw(const carom_record* record, const carom_table* table, double t) {
    enum { kWide = 60, kHigh = 15 };
    char text[kHigh][kWide];
    memset(text, '.', sizeof text);
    for (size_t ball = 0; ball < carom_record_ball_count(record); ++ball) {
        double rvw[9];
        const char* state;
        check(carom_record_state(record, ball, t, rvw, &state));
        const int column = (int)(kWide * (rvw[1] - table->corner[1]) / table->length);
        const int row = (int)(kHigh * (rvw[0] - table->corner[0]) / table->width);
        if (strcmp(state, "pocketed") != 0 && column >= 0 && column < kWide && row >= 0 && row < kHigh)
            text[row][column] = carom_record_ball_id(record, ball)[0];
    }
    printf("%.0f s\n", t);
    for (int row = 0; row < kHigh; ++row) printf("%.*s\n", kWide, text[row]);
}

/* The lowest ball into a pocket that takes it; otherwise straight at the ball. */
static void choose(const carom_scene* scene, const carom_table* table, carom_cue* cue) {
    const char *id, *lowest = "9";
    double white[9], object[9];
    for (size_t i = 0; i < carom_scene_ball_count(scene); ++i) {
        check(carom_scene_ball(scene, i, &id, NULL, NULL));
        if (strcmp(id, "cue") == 0) check(carom_scene_ball(scene, i, NULL, white, NULL));
        if (strcmp(id, lowest) > 0) continue;
        lowest = id;
        check(carom_scene_ball(scene, i, NULL, object, NULL));
    }
    for (size_t i = 0; i < table->pockets; ++i) {
        carom_part pocket;
        carom_aim aim;
        check(carom_scene_part(scene, CAROM_POCKET, i, &pocket));
        check(carom_aim_pot(scene, "cue", cue, lowest, pocket.id, &aim));
        if (!aim.found) continue;
        *cue = aim.cue;
        return;
    }
    cue->aim_deg = atan2(object[1] - white[1], object[0] - white[0]) * 57.29577951308232;
}

int main(int count, char** arguments) {
    carom_scene* scene;
    carom_table table;
    carom_game_state state;
    check(carom_scene_read(count > 1 ? arguments[1] : "scenes/nine_ball_break.toml", &scene));
    check(carom_scene_table(scene, &table));
    check(carom_game_new(CAROM_NINE_BALL, 0, 0, &state));
    for (int shot = 1; shot <= 60 && !state.over; ++shot) {
        carom_record* record;
        carom_verdict* verdict;
        carom_option option;
        check(carom_simulate(scene, -1.0, &record));
        printf("shot %d, player %d\n", shot, state.turn);
        for (double t = 0.0; t < carom_record_duration(record); t += 1.0) draw(record, &table, t);
        draw(record, &table, carom_record_duration(record));
        check(carom_judge(&state, record, NULL, &verdict));
        for (size_t i = 0; i < carom_verdict_foul_count(verdict); ++i)
            printf("foul: %s\n", carom_verdict_foul(verdict, i));
        check(carom_verdict_option(verdict, 0, &option));
        state = option.state;
        if (!state.over) {
            /* In hand, the cue ball goes to the first free place along the head string. */
            double place[2];
            int32_t allowed = 0;
            for (double x = 0.5; state.in_hand != CAROM_NOT_IN_HAND && !allowed && x < 8.0; x += 0.25) {
                check(carom_scene_diamond(scene, "left", 1.9, place));
                place[0] += x / 8.0 * table.width;
                check(carom_may_place(record, verdict, 0, place, &allowed));
            }
            carom_cue cue;
            carom_cue_init(&cue);
            cue.speed = 2.5;
            cue.height = 0.0;
            carom_scene_free(scene);
            check(carom_next_shot(record, verdict, 0, &cue, allowed ? place : NULL, &scene));
            choose(scene, &table, &cue);
            check(carom_scene_set_cue(scene, "cue", &cue));
        }
        carom_verdict_free(verdict);
        carom_record_free(record);
    }
    printf(state.over ? "player %d wins\n" : "no winner\n", state.winner);
    carom_scene_free(scene);
    return 0;
}
