#include "field_video.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <vector>

namespace hypotrack::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kWidth = 4, kHeight = 2;  // of a field, in macroblocks

/// Writes the syntax elements of ITU-T H.264.
class Bits {
 public:
  /// u(n)
  Bits& fixed(int bits, std::uint32_t value) {
    while (bits-- > 0) {
      if (used_ == 0) bytes_.push_back(0);
      bytes_.back() |= static_cast<std::uint8_t>(((value >> bits) & 1) << (7 - used_));
      used_ = (used_ + 1) % 8;
    }
    return *this;
  }
  /// ue(v), one after the other
  Bits& golomb(std::initializer_list<std::uint32_t> values) {
    for (const std::uint32_t value : values)
      fixed(2 * static_cast<int>(std::bit_width(value + 1)) - 1, value + 1);
    return *this;
  }
  Bits& align() {
    used_ = 0;
    return *this;
  }
  /// Returns a NAL unit with its start code.
  Bytes unit(std::uint8_t header) {
    fixed(1, 1).align();
    Bytes out{0, 0, 0, 1, header};
    int zeros = 0;
    for (const std::uint8_t byte : bytes_) {
      if (zeros == 2 && byte <= 3) out.push_back(3);
      if (zeros == 2 && byte <= 3) zeros = 0;
      out.push_back(byte);
      zeros = byte == 0 ? zeros + 1 : 0;
    }
    return out;
  }

 private:
  Bytes bytes_;
  int used_ = 0;  ///< bits of the last byte
};

void append(Bytes& out, const Bytes& more) { out.insert(out.end(), more.begin(), more.end()); }

Bytes parameter_sets() {
  constexpr std::uint32_t kMain = 77, kLevel = 30;
  Bits sequence;
  sequence.fixed(8, kMain).fixed(8, 0).fixed(8, kLevel).golomb({0, 0, 0, 4, 1}).fixed(1, 0);
  sequence.golomb({kWidth - 1, kHeight - 1});
  sequence.fixed(5, 0b00101);                                         // fields, no cropping, VUI
  sequence.fixed(5, 0b00001).fixed(32, 1).fixed(32, 50).fixed(1, 1);  // 50 fields per second
  sequence.fixed(5, 0b00011).golomb({0, 0, 10, 10, 0, 1});            // nothing is reordered
  Bits picture;
  picture.golomb({0, 0}).fixed(2, 0).golomb({0, 0, 0}).fixed(3, 0).golomb({0, 0, 0}).fixed(3,
                                                                                           0b100);
  Bytes out = sequence.unit(0x67);
  append(out, picture.unit(0x68));
  return out;
}

/// Codes a field of one brightness without compression.
Bytes field(std::uint32_t picture, bool second, std::uint32_t brightness) {
  const bool first_of_all = picture == 0 && !second;
  Bits bits;
  bits.golomb({0, 7, 0}).fixed(4, picture % 16).fixed(1, 1).fixed(1, second ? 1 : 0);
  if (first_of_all) bits.golomb({0});
  bits.fixed(8, (2 * picture + (second ? 1 : 0)) % 256).fixed(first_of_all ? 2 : 1, 0);
  bits.golomb({0, 1});
  for (int block = 0; block < kWidth * kHeight; ++block) {
    bits.golomb({25}).align();
    for (int i = 0; i < 256; ++i) bits.fixed(8, brightness);
    for (int i = 0; i < 128; ++i) bits.fixed(8, 128);
  }
  return bits.unit(first_of_all ? 0x65 : 0x61);
}

void check(bool right, const char* what) {
  if (!right) throw std::runtime_error(std::string("cannot write a video: ") + what);
}

void write_packet(AVFormatContext& format, const Bytes& data, std::int64_t field, bool timed) {
  AVPacket* packet = av_packet_alloc();
  check(av_new_packet(packet, static_cast<int>(data.size())) == 0, "no memory");
  std::memcpy(packet->data, data.data(), data.size());
  packet->dts = field;
  packet->pts = timed ? field : AV_NOPTS_VALUE;
  packet->duration = 1;
  packet->flags |= field == 0 ? AV_PKT_FLAG_KEY : 0;
  av_packet_rescale_ts(packet, {1, 50}, format.streams[0]->time_base);
  const int result = av_write_frame(&format, packet);
  av_packet_free(&packet);
  check(result >= 0, "a packet is refused");
}

AVFormatContext* begin_file(const std::filesystem::path& file) {
  AVFormatContext* format = nullptr;
  check(avformat_alloc_output_context2(&format, nullptr, nullptr, file.c_str()) >= 0,
        "no container");
  AVStream& stream = *avformat_new_stream(format, nullptr);
  stream.time_base = {1, 50};
  AVCodecParameters& coded = *stream.codecpar;
  coded.codec_type = AVMEDIA_TYPE_VIDEO;
  coded.codec_id = AV_CODEC_ID_H264;
  coded.width = 16 * kWidth;
  coded.height = 2 * 16 * kHeight;
  const Bytes sets = parameter_sets();
  coded.extradata =
      static_cast<std::uint8_t*>(av_mallocz(sets.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  coded.extradata_size = static_cast<int>(sets.size());
  std::memcpy(coded.extradata, sets.data(), sets.size());
  check(avio_open(&format->pb, file.c_str(), AVIO_FLAG_WRITE) >= 0, "the file does not open");
  check(avformat_write_header(format, nullptr) >= 0, "no header");
  return format;
}

}  // namespace

void write_field_video(const std::filesystem::path& file, int pictures, FieldPackets packets) {
  AVFormatContext* format = begin_file(file);
  for (int i = 0; i < pictures; ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    Bytes first = i == 0 ? parameter_sets() : Bytes();
    append(first, field(number, false, 40 + 8 * number));
    const Bytes second = field(number, true, 44 + 8 * number);
    const bool joined = packets == FieldPackets::joined;
    if (joined) append(first, second);
    write_packet(*format, first, 2 * i, true);
    if (!joined) write_packet(*format, second, 2 * i + 1, packets == FieldPackets::timed);
  }
  check(av_write_trailer(format) >= 0, "no trailer");
  avio_closep(&format->pb);
  avformat_free_context(format);
}

}  // namespace hypotrack::test
