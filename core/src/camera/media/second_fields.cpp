#include <new>

#include "camera/media/packet_times.hpp"

namespace hypotrack::internal {

SecondFields::SecondFields(const Demuxer& video) {
  const AVCodecParameters& coded = *video.pictures().codecpar;
  if (coded.codec_id != AV_CODEC_ID_H264) return;  // parsers of others join fields
  codec_.reset(avcodec_alloc_context3(avcodec_find_decoder(coded.codec_id)));
  if (!codec_) throw std::bad_alloc();
  avcodec_parameters_to_context(codec_.get(), &coded);
  parser_.reset(av_parser_init(coded.codec_id));
  if (parser_) parser_->flags |= PARSER_FLAG_COMPLETE_FRAMES;
}

bool SecondFields::take(const AVPacket& packet) {
  if (!parser_) return false;
  std::uint8_t* data = nullptr;
  int size = 0;
  av_parser_parse2(parser_.get(), codec_.get(), &data, &size, packet.data, packet.size, packet.pts,
                   packet.dts, packet.pos);
  const int parity = parser_->picture_structure;
  const bool field =
      parity == AV_PICTURE_STRUCTURE_TOP_FIELD || parity == AV_PICTURE_STRUCTURE_BOTTOM_FIELD;
  const bool second = field && open_ != 0 && parity != open_;
  open_ = field && !second ? parity : 0;
  return second;
}

}  // namespace hypotrack::internal
