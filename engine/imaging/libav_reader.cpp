#include "core/errors.h"
#include "imaging/libav.h"
#include "imaging/video_writer.h"

namespace cathlab {

using namespace libav;

namespace {

// Decodes a key frame's packet (null: what is left) and compares its size with the container's.
void decode(AVCodecContext& decoder, const AVPacket* packet, AVFrame& frame, const VideoFacts& facts) {
    must(avcodec_send_packet(&decoder, packet), "a picture");
    for (;;) {
        const int code = avcodec_receive_frame(&decoder, &frame);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
        must(code, "a picture");
        if (frame.width != facts.width || frame.height != facts.height)
            throw std::runtime_error("a picture has another size than the film");
    }
}

VideoFacts read(const std::string& path) {
    av_log_set_level(AV_LOG_QUIET);  // faults come back as codes and are told once
    AVFormatContext* opened = nullptr;
    must(avformat_open_input(&opened, path.c_str(), nullptr, nullptr), "container");
    const Owned<AVFormatContext> container(opened);
    must(avformat_find_stream_info(opened, nullptr), "container");
    const AVCodec* codec = nullptr;
    const int index = must(av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0), "pictures");
    const AVStream& stream = *opened->streams[index];
    const Owned<AVCodecContext> decoder(must(avcodec_alloc_context3(codec), "decoder"));
    must(avcodec_parameters_to_context(decoder.get(), stream.codecpar), "decoder");
    decoder->thread_count = 1;
    must(avcodec_open2(decoder.get(), codec, nullptr), "decoder");

    VideoFacts facts;
    facts.width = stream.codecpar->width;
    facts.height = stream.codecpar->height;
    facts.fps = av_q2d(stream.avg_frame_rate);
    const Owned<AVPacket> packet(must(av_packet_alloc(), "decoder"));
    const Owned<AVFrame> frame(must(av_frame_alloc(), "decoder"));
    for (;;) {
        const int code = av_read_frame(opened, packet.get());
        if (code == AVERROR_EOF) break;
        must(code, "a picture");
        if (packet->stream_index == index && packet->size > 0) {
            if ((packet->flags & AV_PKT_FLAG_CORRUPT) != 0) throw std::runtime_error("a picture is cut short");
            ++facts.frames;
            if ((packet->flags & AV_PKT_FLAG_KEY) != 0) decode(*decoder, packet.get(), *frame, facts);
        }
        av_packet_unref(packet.get());
    }
    decode(*decoder, nullptr, *frame, facts);
    return facts;
}

}  // namespace

VideoFacts read_video_facts(const std::string& path) {
    try {
        return read(path);
    } catch (const std::runtime_error& error) {
        throw UserError("cannot read video '" + path + "': " + error.what());
    }
}

}  // namespace cathlab
