#include "font/glyphs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <utility>

namespace carom::render {

namespace {

// In the order of kGlyphs: the outlines of DejaVu Sans Condensed Bold (LICENSE.DejaVu), on a grid of tenths
// of a unit with the origin at the lower left of the letter. A point is two characters, x and y; a blank ends
// a contour, and "!" precedes the middle point of a quadratic curve.
constexpr std::array<std::string_view, kGlyphs.size()> kOutlines{
    R"(NS!N^!KhFh!Bh!>^>S!>H!B>F>!J>!NH \S!\D!Q4F4!;4!0D0S!0b!;rFr!Qr!\b)",
    R"(3@@@@f3d3n?qMqM@Y@Y535)",
    R"(B@Z@Z5252@FT!IV!K[K^!Kb!FhBh!?h!7d3a3o!7p!@rEr!Or!YiY`!Y[!USML)",
    R"(OU!UT!ZLZF!Z=!N4B4!>4!65272C!6A!=>A>!G>!LCLG!LK!FO@O;O;YAY!FY!K]K`!Kd!FhBh!>h!7f4d4p!8q!)"
    R"(@rDr!Or!YjYc!Y]!TW)",
    R"(Hd8KHK EqUqUK\K\@U@U5H5H@0@0M)",
    R"(4qVqVf?f?\!@]!D]E]!O]!ZRZI!Z?!N4D4!?4!66282D!6A!>>A>!G>!LDLI!LM!GSAS!?S!8Q4O)",
    R"(GS!CS!?M?H!?C!C>G>!J>!NCNH!NM!JS XoXd!Uf!NhLh!Eh!>`>Y!@[!F]I]!Q]!\R\I!\?!P4G4!<4!0D0R!0a)"
    R"(!>rJr!Mr!Uq)",
    R"(2qZqZhE585Lf2f)",
    R"(FP!BP!>K>G!>B!B>F>!J>!NBNG!NK!JP <U!7W!2]2c!2j!<rFr!Pr!ZjZc!Z]!UWPU!VS![L[F![=!Q4F4!<4!1)"
    R"(=1F!1L!6S ?a!?]!CZFZ!IZ!M]Ma!Me!IhFh!Ch!?e)",
    R"(464A!7@!=>@>!G>!NFNM!LK!FICI!;I!0T0]!0f!<rEr!Pr!\b\T!\E!N4B4!>4!75 ES!IS!MXM^!Mc!IhEh!Bh)"
    R"(!>c>^!>X!BS)",
    R"(?EMEM5?5)",
    R"(?bMbMR?R ?EMEM5?5)",
    R"(;SQSQG;G)",
    R"(UN!SN!QIQD!Q@!S;U;!W;!Y@YD!YI!WN UU!ZU!`L`D!`=!Z4U4!P4!J=JD!JL!PU <464PrVr 7r!<r!BiBb!BZ)"
    R"(!<Q7Q!2Q!,Z,b!,i!2r 7k!5k!3f3b!3]!5X7X!9X!;];b!;f!9k)",
    R"(KqTq@-8-)",
    R"(JiJT]T]JJJJ5B5BJ/J/TBTBi)",
    R"(/]]]]S/S /J]J]A/A)",
    R"(Q*F*!A4!;F;O!;X!AjFsQs!Lj!HXHO!HF!L4)",
    R"(;*!@4!DFDO!DX!@j;sFs!Kj!QXQO!QF!L4F*)",
    R"(P@<@95,5>qNq`5S5 ?KMKFc)",
    R"(EZ!IZ!L]L`!Lc!IfEf>f>Z F@!J@!NCNG!NK!JOFO>O>@ SU!WT!\L\F!\>!R5G5050qEq!Pq!ZiZa!Z]!VW)",
    R"(]8!Y6!Q4L4!?4!/E/S!/a!?rLr!Qr!Yp]n]a!Yd!RgMg!Fg!=\=S!=J!F?M?!R?!YB]E)",
    R"(;e;A@A!HA!QJQS!Q\!He@e -q;q!Hq!TmXh!\d!_Z_S!_L!\BX>!T9!G5;5-5)",
    R"(3qXqXeAeAZWZWNANAAYAY535)",
    R"(3qYqYeAeAZWZWNANA535)",
    R"(`9![7!O4I4!<4!,E,S!,a!<rJr!Pr!Yp^n^a!Yd!PgLg!Dg!;];S!;I!C?K?!M?!Q@S@SLJLJV`V)",
    R"(.q<q<ZPZPq^q^5P5PN<N<5.5)",
    R"(?qMqM5?5)",
    R"(EqRqR;!R0!G%<%:%:0<0!@0!E6E;)",
    R"(,q:q:[Mq]qDU`5O5:M:5,5)",
    R"(3qAqAAYAY535)",
    R"(,q;qFQQq`q`5U5UaJABA7a75,5)",
    R"(.q=qQHQq^q^5O5;^;5.5)",
    R"(Fg!@g!9\9S!9I!@?F?!L?!SISS!S\!Lg Fr!Rr!`b`S!`D!R4F4!:4!,D,S!,b!:r)",
    R"(0qGq!Qq!\g\]!\T!QJGJ>J>505 >f>UEU!IU!NYN]!Na!IfEf)",
    R"(G4F4!:4!,D,S!,b!:rFr!Rr!`b`S!`I!Y:R6\)P) Fg!@g!9\9S!9I!@?F?!L?!SISS!S\!Lg)",
    R"(AV!FV!JZJ^!Jb!FfAf<f<V <L<5.5.qCq!Nq!XiX`!XZ!RSMQ!PP!UKWF^5P5ID!GH!CL@L)",
    R"(XoXb!Se!KgGg!Bg!=d=a!=^!A[E[KY!TW![O[G![>!Q4F4!A4!66181E!6B!@?E?!I?!NBNF!NH!KKFM@N!8P!1X)"
    R"(1_!1h!;rEr!Ir!Sq)",
    R"(-q_q_eMeM5?5?e-e)",
    R"(/q=q=M!=F!A?F?!K?!OFOMOq]q]M!]@!R4F4!:4!/@/M)",
    R"(,q9qFESq`qN5>5)",
    R"(,q5q;EBqKqQEWq`qW5M5Fc?555)",
    R"(NT`5R5FI:5,5>T-q;qF^Qq_q)",
    R"(,q:qF\Rq`qMNM5?5?N)",
    R"(/q]q]h@A^A^5.5.>Ke/e)",
    R"(VaVV!RX!JZFZ!CZ!?W?U!?T!BREQHQ!RP!XIXB!X;!O4E4!A4!95474B!8?!@=D=!H=!L@LB!LD!IFEFCG!;H!4N)"
    R"(4U!4\!<cFc!Ic!Qb)",
    R"(J[!L_!QcUc!Zc!`Z`P`5V5VL!VM!VNVO!VT!TXQX!NX!KQKKK5A5AL!AT!?X=X!:X!6Q6K65,5,b6b6[!8_!=c@c)"
    R"(!Dc!I_)",
    R"(FY!BY!=R=K!=E!B>F>!J>!OEOK!OR!JY Fc!Qc!\W\K!\@!Q4F4!<4!0@0K!0W!<c)",
    R"(VtVjOj!Lj!JhJeJbUbUXJXJ5=5=X6X6b=b=e!=l!DtLt)"};
constexpr char kFirst = '#';             // 0 on the grid
constexpr int kGridX = 15, kGridY = 18;  // of the origin
constexpr float kGridStep = 0.1F;        // [units]

// [units] Distance of the 4 x 6 glyph from the edges of its cell; it is centred in the cell.
constexpr float kMarginX = (kGlyphUnitsX - 4.0F) / 2.0F, kMarginY = (kGlyphUnitsY - 6.0F) / 2.0F;

struct Point {
    float x, y;
    bool curve;  // the middle point of a quadratic curve
};
using Contour = std::vector<Point>;

Point middle(const Point& a, const Point& b) {
    return {0.5F * (a.x + b.x), 0.5F * (a.y + b.y), false};
}

// Appends a contour as a polygon: curves become pieces, and of two middle points the point between them is on
// the outline.
void flatten(const Contour& contour, std::vector<std::pair<Point, Point>>& sides) {
    constexpr int kPieces = 5;
    const std::size_t n = contour.size();
    Point at = contour[0].curve ? middle(contour[0], contour[n - 1]) : contour[0];
    for (std::size_t i = 0; i < n; ++i) {
        const Point &here = contour[i], &next = contour[(i + 1) % n];
        if (!here.curve && next.curve) continue;
        const Point end = here.curve && next.curve ? middle(here, next) : next;
        if (!here.curve) {
            sides.emplace_back(at, end);
            at = end;
            continue;
        }
        const Point from = at;
        for (int piece = 1; piece <= kPieces; ++piece) {
            const float t = static_cast<float>(piece) / kPieces, a = (1.0F - t) * (1.0F - t),
                        b = 2.0F * t * (1.0F - t), c = t * t;
            const Point to{a * from.x + b * here.x + c * end.x, a * from.y + b * here.y + c * end.y, false};
            sides.emplace_back(at, to);
            at = to;
        }
    }
}

std::vector<std::pair<Point, Point>> sides_of(std::string_view outline) {
    std::vector<std::pair<Point, Point>> sides;
    Contour contour;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        if (outline[i] == ' ') {
            flatten(contour, sides);
            contour.clear();
            continue;
        }
        const bool curve = outline[i] == '!';
        if (curve) ++i;
        contour.push_back({kGridStep * static_cast<float>(outline[i] - kFirst - kGridX),
                           kGridStep * static_cast<float>(outline[i + 1] - kFirst - kGridY), curve});
        ++i;
    }
    flatten(contour, sides);
    return sides;
}

// [units] Negative inside.
float distance_to_outline(const std::vector<std::pair<Point, Point>>& sides, float x, float y) {
    float nearest = kGlyphReach * kGlyphReach;
    bool inside = false;
    for (const auto& [a, b] : sides) {
        const float dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
        const float t =
            length2 > 0.0F ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / length2, 0.0F, 1.0F) : 0.0F;
        const float ex = x - a.x - t * dx, ey = y - a.y - t * dy;
        nearest = std::min(nearest, ex * ex + ey * ey);
        if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) * dx / dy) inside = !inside;
    }
    return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
}

std::vector<std::uint8_t> make_atlas() {
    constexpr int kWidth = kGlyphColumns * kGlyphWidth, kHeight = kGlyphRows * kGlyphHeight;
    std::vector<std::uint8_t> atlas(std::size_t{kWidth} * kHeight, 0);
    for (std::size_t cell = 0; cell < kOutlines.size(); ++cell) {
        const int column = static_cast<int>(cell) % kGlyphColumns,
                  row = static_cast<int>(cell) / kGlyphColumns;
        const std::vector<std::pair<Point, Point>> sides = sides_of(kOutlines[cell]);
        for (int ty = 0; ty < kGlyphHeight; ++ty) {
            for (int tx = 0; tx < kGlyphWidth; ++tx) {
                const float x = (static_cast<float>(tx) + 0.5F) * kGlyphUnitsX / kGlyphWidth - kMarginX;
                const float y =
                    kGlyphUnitsY - (static_cast<float>(ty) + 0.5F) * kGlyphUnitsY / kGlyphHeight - kMarginY;
                const float near = 0.5F - 0.5F * distance_to_outline(sides, x, y) / kGlyphReach;
                const std::size_t texel = static_cast<std::size_t>(row * kGlyphHeight + ty) * kWidth +
                                          static_cast<std::size_t>(column * kGlyphWidth + tx);
                atlas[texel] = static_cast<std::uint8_t>(std::lround(255.0F * near));
            }
        }
    }
    return atlas;
}

}  // namespace

int glyph_index(char c) {
    std::size_t found = kGlyphs.find(c);
    if (found == std::string_view::npos)
        found = kGlyphs.find(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
    return found == std::string_view::npos ? -1 : static_cast<int>(found);
}

const std::vector<std::uint8_t>& glyph_atlas() {
    static const std::vector<std::uint8_t> kAtlas = make_atlas();
    return kAtlas;
}

float glyph_distance(const std::vector<std::uint8_t>& atlas, int cell, float x, float y) {
    const int column = cell % kGlyphColumns, row = cell / kGlyphColumns;
    const float across = (static_cast<float>(column) + x) * kGlyphWidth - 0.5F,
                down = (static_cast<float>(row) + y) * kGlyphHeight - 0.5F;
    const auto texel = [&](int i, int j) {
        i = std::clamp(i, 0, kGlyphColumns * kGlyphWidth - 1);
        j = std::clamp(j, 0, kGlyphRows * kGlyphHeight - 1);
        return static_cast<float>(atlas[static_cast<std::size_t>(j) * kGlyphColumns * kGlyphWidth +
                                        static_cast<std::size_t>(i)]) /
               255.0F;
    };
    const int i = static_cast<int>(std::floor(across)), j = static_cast<int>(std::floor(down));
    const float u = across - static_cast<float>(i), v = down - static_cast<float>(j);
    const float near = (1.0F - v) * ((1.0F - u) * texel(i, j) + u * texel(i + 1, j)) +
                       v * ((1.0F - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
    return (1.0F - 2.0F * near) * kGlyphReach;
}

}  // namespace carom::render
