// A 64-bit hash of bytes (FNV-1a over 8-byte words, then mixed), and the archive through which states are hashed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/archive.h"

namespace cathlab {

class Hash64 {
public:
    void bytes(const void* data, std::size_t size);
    void word(std::uint64_t value);
    void text(std::string_view value);
    std::uint64_t value() const;

private:
    std::uint64_t state_ = 0xCBF29CE484222325ULL;
};

/// Sixteen lower-case hexadecimal digits.
std::string hash_text(std::uint64_t hash);

/// The hash of a file's bytes; throws UserError where it cannot be read.
std::uint64_t hash_file(const std::string& path);

/// Visits a state and hashes every field's bit pattern; names and array sizes go in too.  -0 and +0 differ, NaN is
/// itself.
class HashArchive final : public Archive {
public:
    std::uint64_t value() const { return hash_.value(); }

protected:
    void numbers(std::string_view name, double* data, std::size_t size) override;
    void numbers(std::string_view name, float* data, std::size_t size) override;
    void numbers(std::string_view name, std::int64_t* data, std::size_t size) override;

private:
    Hash64 hash_;
};

}  // namespace cathlab
