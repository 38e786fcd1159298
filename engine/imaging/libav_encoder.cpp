#include "imaging/libav_encoder.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <array>

#include "core/check.h"
#include "imaging/libav.h"

namespace cathlab {

using namespace libav;

namespace {

// Quantum noise is what a fluoroscopy's bits go into.  At equal size and likeness (SSIM) to x264's usual preset
// `medium` with CRF 23, `superfast` takes a fifth of its time; the CRF lies a step on the finer side.
constexpr const char* h264_preset = "superfast";
constexpr const char* h264_crf = "25";
constexpr double key_frame_s = 4.0;  // a player jumps to these

const AVCodec* find(FilmCodec codec) {
    switch (codec) {
        case FilmCodec::h264: return avcodec_find_encoder_by_name("libx264");
        case FilmCodec::mpeg4: return avcodec_find_encoder(AV_CODEC_ID_MPEG4);
        case FilmCodec::lossless: return avcodec_find_encoder(AV_CODEC_ID_FFV1);
    }
    return nullptr;
}

}  // namespace

struct LibavEncoder::Impl {
    Owned<AVFormatContext> container;
    Owned<AVCodecContext> encoder;
    Owned<AVFrame> frame;
    Owned<AVPacket> packet;
    Owned<SwsContext> colours;
    AVStream* stream = nullptr;  // the container's
    std::int64_t count = 0;

    void open_encoder(FilmCodec codec, int width, int height, double fps);
    void write_packets(const AVFrame* picture);
};

void LibavEncoder::Impl::open_encoder(FilmCodec codec, int width, int height, double fps) {
    const AVCodec* found = find(codec);
    if (found == nullptr) throw std::runtime_error("this libavcodec has no such encoder");
    encoder.reset(must(avcodec_alloc_context3(found), "encoder"));
    encoder->width = width;
    encoder->height = height;
    encoder->framerate = av_d2q(fps, 100000);
    encoder->time_base = av_inv_q(encoder->framerate);
    encoder->thread_count = 1;
    encoder->gop_size = static_cast<int>(key_frame_s * fps) + 1;
    encoder->flags |= AV_CODEC_FLAG_BITEXACT;
    if ((container->oformat->flags & AVFMT_GLOBALHEADER) != 0) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (codec == FilmCodec::lossless) {
        encoder->pix_fmt = AV_PIX_FMT_0RGB32;
    } else {
        encoder->pix_fmt = AV_PIX_FMT_YUV420P;
        encoder->colorspace = AVCOL_SPC_SMPTE170M;  // what swscale makes
        encoder->color_range = AVCOL_RANGE_MPEG;
    }
    if (codec == FilmCodec::h264) {
        av_opt_set(encoder->priv_data, "preset", h264_preset, 0);
        av_opt_set(encoder->priv_data, "crf", h264_crf, 0);
    }
    if (codec == FilmCodec::mpeg4) {
        encoder->flags |= AV_CODEC_FLAG_QSCALE;
        encoder->global_quality = 3 * FF_QP2LAMBDA;
    }
    must(avcodec_open2(encoder.get(), found, nullptr), "encoder");
}

// What the encoder has ready after one more picture (null: the end) goes into the file.
void LibavEncoder::Impl::write_packets(const AVFrame* picture) {
    must(avcodec_send_frame(encoder.get(), picture), "encoder");
    for (;;) {
        const int code = avcodec_receive_packet(encoder.get(), packet.get());
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
        must(code, "encoder");
        packet->stream_index = stream->index;
        packet->duration = 1;
        av_packet_rescale_ts(packet.get(), encoder->time_base, stream->time_base);
        must(av_interleaved_write_frame(container.get(), packet.get()), "file");
    }
}

bool LibavEncoder::knows(FilmCodec codec) {
    return find(codec) != nullptr;
}

LibavEncoder::LibavEncoder(const std::string& path, FilmCodec codec, int width, int height, double fps)
    : impl_(std::make_unique<Impl>()) {
    av_log_set_level(AV_LOG_QUIET);  // faults come back as codes and are told once
    AVFormatContext* container = nullptr;
    must(avformat_alloc_output_context2(&container, nullptr, nullptr, path.c_str()), "container");
    impl_->container.reset(container);
    container->flags |= AVFMT_FLAG_BITEXACT;
    impl_->open_encoder(codec, width, height, fps);

    impl_->stream = must(avformat_new_stream(container, nullptr), "container");
    impl_->stream->time_base = impl_->encoder->time_base;
    impl_->stream->avg_frame_rate = impl_->encoder->framerate;
    must(avcodec_parameters_from_context(impl_->stream->codecpar, impl_->encoder.get()), "container");
    must(avio_open(&container->pb, path.c_str(), AVIO_FLAG_WRITE), "file");
    must(avformat_write_header(container, nullptr), "file");

    impl_->packet.reset(must(av_packet_alloc(), "encoder"));
    impl_->frame.reset(must(av_frame_alloc(), "encoder"));
    impl_->frame->format = impl_->encoder->pix_fmt;
    impl_->frame->width = width;
    impl_->frame->height = height;
    must(av_frame_get_buffer(impl_->frame.get(), 0), "encoder");
    impl_->colours.reset(must(sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, impl_->encoder->pix_fmt,
                                             SWS_BICUBIC, nullptr, nullptr, nullptr),
                              "colours"));
}

LibavEncoder::~LibavEncoder() = default;

void LibavEncoder::write(const Image8& picture) {
    Impl& self = *impl_;
    CATHLAB_CHECK(picture.width == self.encoder->width && picture.height == self.encoder->height,
                  "a picture's size differs from the film's");
    must(av_frame_make_writable(self.frame.get()), "encoder");  // the encoder may still hold the last one
    const std::array<const std::uint8_t*, 1> from{picture.rgb.data()};
    const std::array<int, 1> stride{3 * picture.width};
    sws_scale(self.colours.get(), from.data(), stride.data(), 0, picture.height, self.frame->data,
              self.frame->linesize);
    self.frame->pts = self.count++;
    self.write_packets(self.frame.get());
}

void LibavEncoder::finish() {
    impl_->write_packets(nullptr);
    must(av_write_trailer(impl_->container.get()), "file");
    must(avio_closep(&impl_->container->pb), "file");
}

}  // namespace cathlab
