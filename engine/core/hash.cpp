#include "core/hash.h"

#include <array>
#include <cstring>
#include <fstream>

#include "core/errors.h"

namespace cathlab {

void Hash64::word(std::uint64_t value) {
    state_ = (state_ ^ value) * 0x100000001B3ULL;
    state_ ^= state_ >> 29U;
}

void Hash64::bytes(const void* data, std::size_t size) {
    const auto* p = static_cast<const unsigned char*>(data);
    word(size);
    while (size >= 8) {
        std::uint64_t w = 0;
        std::memcpy(&w, p, 8);
        word(w);
        p += 8;
        size -= 8;
    }
    if (size > 0) {
        std::uint64_t w = 0;
        std::memcpy(&w, p, size);
        word(w);
    }
}

void Hash64::text(std::string_view value) {
    bytes(value.data(), value.size());
}

std::uint64_t Hash64::value() const {
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
}

std::string hash_text(std::uint64_t hash) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out(16, '0');
    for (std::size_t i = 0; i < 16; ++i) out[15 - i] = digits[(hash >> (4 * i)) & 15U];
    return out;
}

std::uint64_t hash_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw UserError(path + ": cannot be read");
    Hash64 hash;
    std::array<char, 65536> buffer{};
    while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || in.gcount() > 0)
        hash.bytes(buffer.data(), static_cast<std::size_t>(in.gcount()));
    return hash.value();
}

void HashArchive::numbers(std::string_view name, double* data, std::size_t size) {
    hash_.text(name);
    hash_.bytes(data, size * sizeof(double));
}

void HashArchive::numbers(std::string_view name, float* data, std::size_t size) {
    hash_.text(name);
    hash_.bytes(data, size * sizeof(float));
}

void HashArchive::numbers(std::string_view name, std::int64_t* data, std::size_t size) {
    hash_.text(name);
    hash_.bytes(data, size * sizeof(std::int64_t));
}

}  // namespace cathlab
