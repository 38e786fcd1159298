// Owners for libav's objects and its error codes as exceptions.  For this room's .cpp files only.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <memory>
#include <stdexcept>
#include <string>

namespace cathlab::libav {

struct Deleter {
    void operator()(AVFormatContext* context) const {
        if (context->iformat != nullptr) {
            avformat_close_input(&context);
        } else {
            avio_closep(&context->pb);
            avformat_free_context(context);
        }
    }
    void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
    void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

// A library's error code as an exception in its own words.
inline int must(int code, const char* what) {
    if (code >= 0) return code;
    std::array<char, AV_ERROR_MAX_STRING_SIZE> words{};
    av_strerror(code, words.data(), words.size());
    throw std::runtime_error(std::string(what) + ": " + words.data());
}

template <class T>
T* must(T* made, const char* what) {
    if (made == nullptr) throw std::runtime_error(std::string(what) + ": out of memory");
    return made;
}

}  // namespace cathlab::libav
