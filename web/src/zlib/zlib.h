// The checksum of zlib, the only part that carom needs in WebAssembly.
#pragma once

#include <cstddef>
#include <cstdint>

inline std::uint32_t crc32_z(std::uint32_t crc, const std::uint8_t* bytes, std::size_t size) {
    constexpr std::uint32_t kPolynomial = 0xedb88320;
    crc = ~crc;
    for (std::size_t i = 0; i < size; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (kPolynomial & (0 - (crc & 1)));
    }
    return ~crc;
}
