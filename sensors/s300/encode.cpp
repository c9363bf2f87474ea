#include "sensors/s300/encode.hpp"

#include "core/crc16.hpp"

namespace madori::sensors::s300 {
namespace {

void put_be(std::vector<std::uint8_t>& out, std::uint32_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>((value >> (8 * i)) & 0xFFU));
}
void put_le(std::vector<std::uint8_t>& out, std::uint16_t value) {
  out.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  out.push_back(static_cast<std::uint8_t>(value >> 8U));
}

std::size_t stated_words(Variant variant, std::size_t total_bytes) {
  if (variant == Variant::V0201) return (total_bytes - 4) / 2;
  return variant == Variant::V0301 ? (total_bytes - 8) / 2 : (total_bytes - 14) / 2;
}

}  // namespace

std::vector<std::uint8_t> encode(const Telegram& telegram) {
  const bool has_field = telegram.content != Content::InputsOutputs;
  const std::size_t total = 24 + (has_field ? 2U : 0U) + 2 * telegram.values.size();
  std::vector<std::uint8_t> out(6, 0);
  out.reserve(total);
  put_be(out, static_cast<std::uint32_t>(stated_words(telegram.variant, total)), 2);
  out.push_back(0xFF);
  out.push_back(telegram.device_address);
  put_be(out, telegram.variant == Variant::V0201 ? 0x0201 : 0x0301, 2);
  put_be(out, telegram.status, 2);
  put_be(out, telegram.scan_number, 4);
  put_be(out, telegram.telegram_number, 2);
  put_be(out, static_cast<std::uint16_t>(telegram.content), 2);
  if (has_field) put_be(out, telegram.field, 2);
  for (const std::uint16_t value : telegram.values) put_le(out, value);
  put_le(out, crc16(out.data() + 4, out.size() - 4));
  return out;
}

}  // namespace madori::sensors::s300
