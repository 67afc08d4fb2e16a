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

static double number(const carom_value* value, const char* path) {
    double found;
    check(carom_value_number(value, path, &found));
    return found;
}

static const char* text(const carom_value* value, const char* path) {
    const char* found;
    check(carom_value_text(value, path, &found));
    return found;
}

/* The path of a part of an item: "balls[3].id". */
static const char* at(const char* list, size_t index, const char* key) {
    static char path[64];
    snprintf(path, sizeof path, "%s[%zu].%s", list, index, key);
    return path;
}

/* The table lies on its side: y goes to the right. */
static void draw(const carom_record* record, const carom_value* table, double t) {
    enum { kWide = 60, kHigh = 15 };
    char lines[kHigh][kWide];
    memset(lines, '.', sizeof lines);
    for (size_t ball = 0; ball < carom_record_ball_count(record); ++ball) {
        double rvw[9];
        const char* state;
        check(carom_record_state(record, ball, t, rvw, &state));
        const int column = (int)(kWide * (rvw[1] - number(table, "corner[1]")) / number(table, "length"));
        const int row = (int)(kHigh * (rvw[0] - number(table, "corner[0]")) / number(table, "width"));
        if (strcmp(state, "pocketed") != 0 && column >= 0 && column < kWide && row >= 0 && row < kHigh)
            lines[row][column] = carom_record_ball_id(record, ball)[0];
    }
    printf("%.0f s\n", t);
    for (int row = 0; row < kHigh; ++row) printf("%.*s\n", kWide, lines[row]);
}

/* The ball that must be hit first into a pocket that takes it; otherwise straight at the ball. */
static void choose(const carom_value* state, const carom_scene* scene, carom_cue* cue) {
    carom_value *legal, *plan, *aim;
    check(carom_legal(state, scene, &legal));
    check(carom_scene_plan(scene, &plan));
    const char* first = text(legal, "first[0]");
    double white[2] = {0, 0}, object[2] = {0, 0};
    for (size_t i = 0; i < carom_value_count(plan, "balls"); ++i) {
        const char* id = text(plan, at("balls", i, "id"));
        if (strcmp(id, "cue") != 0 && strcmp(id, first) != 0) continue;
        double* place = strcmp(id, first) == 0 ? object : white;
        place[0] = number(plan, at("balls", i, "position[0]"));
        place[1] = number(plan, at("balls", i, "position[1]"));
    }
    cue->aim_deg = atan2(object[1] - white[1], object[0] - white[0]) * 57.29577951308232;
    int found = 0;
    for (size_t i = 0; !found && i < carom_value_count(plan, "table.pockets"); ++i) {
        check(carom_aim_pot(scene, "cue", cue, first, text(plan, at("table.pockets", i, "id")), &aim));
        const double aim_deg = number(aim, "aim_deg"); /* NaN if there is none */
        found = !isnan(aim_deg);
        if (found) cue->aim_deg = aim_deg;
        carom_value_free(aim);
    }
    carom_value_free(legal);
    carom_value_free(plan);
}

int main(int count, char** arguments) {
    carom_scene* scene;
    carom_value *plan, *table, *state;
    check(carom_scene_read(count > 1 ? arguments[1] : "scenes/nine_ball_break.toml", &scene));
    check(carom_scene_plan(scene, &plan));
    check(carom_value_part(plan, "table", &table));
    check(carom_game_new("nine_ball", NULL, &state));
    for (int shot = 1; shot <= 60 && number(state, "over") == 0; ++shot) {
        carom_record* record;
        carom_value* verdict;
        check(carom_simulate(scene, -1.0, &record));
        printf("shot %d, player %.0f\n", shot, number(state, "turn"));
        for (double t = 0.0; t < carom_record_duration(record); t += 1.0) draw(record, table, t);
        draw(record, table, carom_record_duration(record));
        check(carom_judge(state, record, NULL, &verdict));
        for (size_t i = 0; i < carom_value_count(verdict, "fouls"); ++i)
            printf("foul: %s\n", text(verdict, at("fouls", i, "foul")));
        carom_value_free(state);
        check(carom_value_part(verdict, "options[0].state", &state));
        if (number(state, "over") == 0) {
            /* In hand, the cue ball goes to the first free place along the head string. */
            const int in_hand = strcmp(text(state, "in_hand"), "no") != 0;
            double place[2];
            int32_t allowed = 0;
            for (double x = 0.5; in_hand && !allowed && x < 8.0; x += 0.25) {
                check(carom_scene_diamond(scene, "left", 1.9, place));
                place[0] += x / 8.0 * number(table, "width");
                check(carom_may_place(record, verdict, 0, place, &allowed));
            }
            carom_cue cue;
            carom_cue_init(&cue);
            cue.speed = 2.5;
            cue.height = 0.0;
            carom_scene_free(scene);
            check(carom_next_shot(record, verdict, 0, &cue, allowed ? place : NULL, &scene));
            choose(state, scene, &cue);
            check(carom_scene_set_cue(scene, "cue", &cue));
        }
        carom_value_free(verdict);
        carom_record_free(record);
    }
    if (number(state, "over") == 0)
        printf("no winner\n");
    else
        printf("player %.0f wins\n", number(state, "winner"));
    carom_value_free(state);
    carom_value_free(table);
    carom_value_free(plan);
    carom_scene_free(scene);
    return 0;
}
