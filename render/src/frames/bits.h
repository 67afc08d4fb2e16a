// Bits in the order of deflate: the first one is the lowest bit of the first byte.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace carom::render {

/// [bytes] A reader may read this far past the last bit, and a writer writes this far: their buffers are
/// longer.
inline constexpr std::size_t kBitsSlack = 8;

inline std::uint64_t load_little(const std::uint8_t* at) {
    std::uint64_t value = 0;
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&value, at, sizeof value);
    } else {
        for (unsigned i = 0; i < 8; ++i) value |= std::uint64_t{at[i]} << (8 * i);
    }
    return value;
}

inline void store_little(std::uint8_t* at, std::uint64_t value) {
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(at, &value, sizeof value);
    } else {
        for (unsigned i = 0; i < 8; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
}

/// Bits that are written together, the first one lowest.
struct Bits {
    std::uint64_t value = 0;
    unsigned count = 0;  ///< at most 56

    Bits operator+(Bits next) const { return {value | (next.value << count), count + next.count}; }
};

class BitWriter {
  public:
    explicit BitWriter(std::uint8_t* bytes) : start_(bytes), at_(bytes) {}

    void put(Bits bits) {
        waiting_ |= bits.value << count_;
        count_ += bits.count;
        store_little(at_, waiting_);
        at_ += count_ / 8;
        waiting_ >>= count_ & 56U;
        count_ %= 8;
    }

    /// Appends `count` bits of `from`, starting at its bit `first`.
    void copy(const std::uint8_t* from, std::size_t first, std::size_t count) {
        constexpr unsigned kStep = 56;  // bits that a 64-bit read at a byte is sure to contain
        const auto bits_at = [from](std::size_t bit) { return load_little(from + bit / 8) >> (bit % 8); };
        for (; count > kStep; count -= kStep, first += kStep)
            put({bits_at(first) & ((std::uint64_t{1} << kStep) - 1), kStep});
        if (count > 0)
            put({bits_at(first) & ((std::uint64_t{1} << count) - 1), static_cast<unsigned>(count)});
    }

    /// Number of bits since the start.
    std::size_t count() const { return static_cast<std::size_t>(at_ - start_) * 8 + count_; }

  private:
    std::uint8_t* start_;
    std::uint8_t* at_;  // the byte that is not full yet
    std::uint64_t waiting_ = 0;
    unsigned count_ = 0;  // bits already in it
};

}  // namespace carom::render
