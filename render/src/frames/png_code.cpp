#include "frames/png_code.h"

namespace carom::render::png_code {

namespace {

constexpr int kEnd = 256, kFirstRun = 257;  // in deflate (RFC 1951, 3.2.5)
constexpr int kCount = 284;                 // codes up to that of the longest run

struct Repeated {
    unsigned length, codes;
};
// Lengths of the codes [bits], and how many consecutive codes have each; 0: no run of whole pixels has this
// code. By lab/measure/png_code_lengths.py from 1080p frames of five tables and seven cameras.
constexpr Repeated kLengthsInRows[] = {
    {1, 1},  {3, 1},  {5, 1}, {6, 1}, {7, 1}, {8, 1}, {9, 1}, {10, 3}, {11, 7}, {12, 223},
    {11, 6}, {10, 3}, {9, 2}, {8, 1}, {7, 1}, {6, 1}, {5, 1}, {3, 1},  {12, 1}, {10, 1},
    {0, 2},  {11, 1}, {0, 2}, {8, 1}, {0, 1}, {8, 1}, {0, 1}, {8, 3},  {9, 1},  {8, 1},
    {9, 1},  {8, 1},  {9, 1}, {8, 1}, {9, 1}, {8, 1}, {9, 4}, {7, 1},
};

using Lengths = std::array<unsigned, kCount>;

constexpr Lengths make_lengths() {
    Lengths lengths{};
    std::size_t next = 0;
    for (const Repeated& row : kLengthsInRows)
        for (unsigned i = 0; i < row.codes; ++i) lengths.at(next++) = row.length;
    return lengths;
}

constexpr Lengths kLengths = make_lengths();

// Decoders refuse incomplete and oversubscribed codes: the shares 2^-length must add up to 1.
constexpr bool is_complete() {
    unsigned sum = 0;
    for (const unsigned length : kLengths)
        if (length > 0) sum += 1U << (kLongestCode - length);
    return sum == 1U << kLongestCode;
}
static_assert(is_complete());

constexpr std::uint32_t reversed(std::uint32_t value, unsigned count) {
    std::uint32_t result = 0;
    for (unsigned i = 0; i < count; ++i) result |= ((value >> i) & 1U) << (count - 1 - i);
    return result;
}

// RFC 1951, 3.2.2: shorter codes first; codes of the same length in the order of their symbols.
constexpr std::array<Code, kCount> make_codes() {
    std::array<Code, kCount> codes{};
    std::uint32_t next = 0;
    for (unsigned length = 1; length <= kLongestCode; ++length, next <<= 1) {
        for (std::size_t symbol = 0; symbol < codes.size(); ++symbol)
            if (kLengths[symbol] == length) codes[symbol] = {reversed(next++, length), length};
    }
    return codes;
}

// RFC 1951, 3.2.5: 8 lengths have their own codes; after them, every group of four codes has one more extra
// bit.
constexpr Code run_code(const std::array<Code, kCount>& codes, unsigned bytes) {
    unsigned code = kFirstRun, least = 3, extra = 0;
    for (; least + (1U << extra) <= bytes; ++code) {
        least += 1U << extra;
        if (code >= kFirstRun + 7 && (code - kFirstRun) % 4 == 3) ++extra;
    }
    const Code& found = codes.at(code);
    const std::uint32_t length = found.value | ((bytes - least) << found.count);
    // Two distances have one-bit codes, so that these are complete too; ours is the second.
    return {length | (1U << (found.count + extra)), found.count + extra + 1};
}

constexpr Codes make_all() {
    const std::array<Code, kCount> codes = make_codes();
    Codes all;
    for (std::size_t i = 0; i < all.byte.size(); ++i) all.byte[i] = codes[i];
    all.end = codes[kEnd];
    for (std::size_t n = 1; n < all.run.size(); ++n)
        all.run[n] = run_code(codes, 3 * static_cast<unsigned>(n));
    return all;
}

}  // namespace

constexpr Codes kCodes = make_all();

void write_head(BitWriter& out) {
    constexpr unsigned kLast = 1, kOwnCodes = 2, kDistances = 3;
    out.put({kLast | (kOwnCodes << 1), 3});
    out.put({(kCount - kFirstRun) | ((kDistances - 1) << 5) | (15U << 10), 14});
    // The lengths themselves are written in four bits: 4-bit codes for the lengths 0 to 15, none for
    // repetitions (16 to 18), whose three entries come first.
    constexpr unsigned kRepetitions = 3, kPlain = 16;
    for (unsigned i = 0; i < kRepetitions; ++i) out.put({0, 3});
    for (unsigned i = 0; i < kPlain; ++i) out.put({4, 3});
    for (const unsigned length : kLengths) out.put({reversed(length, 4), 4});
    for (const unsigned length : {1U, 0U, 1U}) out.put({reversed(length, 4), 4});  // distances 1, 2, 3
}

}  // namespace carom::render::png_code
