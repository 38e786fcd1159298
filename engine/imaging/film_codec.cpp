#include "imaging/film_codec.h"

#include <vector>

#include "core/errors.h"

namespace cathlab {
namespace {

struct NamedCodec {
    const char* name;
    FilmCodec codec;
    const char* extension;
};
// The first of an extension whose encoder is there is its usual one.
constexpr NamedCodec named_codecs[] = {
    {"h264", FilmCodec::h264, ".mp4"}, {"mpeg4", FilmCodec::mpeg4, ".mp4"}, {"ffv1", FilmCodec::lossless, ".avi"}};

}  // namespace

FilmCodec choose_codec(const std::string& path, const std::string& extension, const std::string& name,
                       const std::function<bool(FilmCodec)>& has_encoder) {
    std::vector<std::string> names, here;
    const NamedCodec *wanted = nullptr, *usual = nullptr;
    for (const NamedCodec& known : named_codecs) {
        names.emplace_back(known.name);
        const bool is_here = has_encoder(known.codec);
        if (is_here) here.emplace_back(known.name);
        if (name == known.name) wanted = &known;
        if (is_here && usual == nullptr && extension == known.extension) usual = &known;
    }
    const std::string start = "cannot write video '" + path + "': ";
    const std::string it_has = here.empty() ? "it has none that cathlab writes" : "it has " + comma_list(here);
    if (name.empty()) {
        if (usual == nullptr) throw UserError(start + "this system has no encoder for " + extension + "; " + it_has);
        return usual->codec;
    }
    if (wanted == nullptr)
        throw UserError(start + "there is no codec '" + name + "'; known are " + comma_list(names) +
                        did_you_mean(name, names));
    if (extension != wanted->extension)
        throw UserError(start + "the codec " + name + " goes into a file " + wanted->extension);
    if (!has_encoder(wanted->codec)) throw UserError(start + "this system has no encoder of " + name + "; " + it_has);
    return wanted->codec;
}

}  // namespace cathlab
