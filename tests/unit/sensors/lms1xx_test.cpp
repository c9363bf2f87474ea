#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "core/angle.hpp"
#include "sensors/lms1xx/encode.hpp"

namespace madori::sensors::lms1xx {
namespace {

std::string shared(const std::string& name) {
  std::ifstream stream(std::filesystem::path(MADORI_SHARED_DATA) / "sick" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}
std::string text_of(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

ScanData sample() {
  ScanData data;
  data.serial = 0xA037B9;
  data.telegram_counter = 0xC1C3;
  data.encoders = {{7, 9}};
  data.channels16.resize(1);
  data.channels16[0].name = {'D', 'I', 'S', 'T', '1'};
  for (std::uint16_t i = 0; i < 541; ++i)
    data.channels16[0].values.push_back(static_cast<std::uint16_t>(i * 40U));
  data.channels8.resize(1);
  data.channels8[0].name = {'R', 'S', 'S', 'I', '1'};
  data.channels8[0].values.assign(541, 99);
  return data;
}

TEST(Lms1xxCapture, TheTextTelegramHas541Ranges) {
  const std::string text = shared("lms1xx_cola_a_541pt.txt");
  if (text.empty()) GTEST_SKIP() << "the recorded telegram is absent";
  Bytes payload = bytes_of(text);
  std::erase_if(payload, [](auto c) { return c < 0x20; });
  const auto data = decode_scan(Dialect::A, payload);
  ASSERT_TRUE(data) << data.reason();
  EXPECT_EQ(data.value().serial, 0xA037B9U);
  EXPECT_EQ(data.value().telegram_counter, 0xC1C3);
  EXPECT_EQ(data.value().scan_frequency, 5000U);
  EXPECT_EQ(data.value().measurement_frequency, 360U);
  const auto scan = to_laser_scan(data.value());
  ASSERT_TRUE(scan) << scan.reason();
  ASSERT_EQ(scan.value().ranges_m.size(), 541U);
  EXPECT_NEAR(to_deg(scan.value().angle_min_rad), -135.0, 1e-9);
  EXPECT_NEAR(to_deg(scan.value().angle_rad(540)), 135.0, 1e-9);
  EXPECT_FLOAT_EQ(scan.value().ranges_m[0], 0.659F);
  EXPECT_FLOAT_EQ(scan.value().ranges_m[1], 0.626F);
  const auto& values = data.value().channels16[0].values;
  const auto codes = std::count_if(values.begin(), values.end(), [](auto value) { return value < 16; });
  EXPECT_GT(codes, 0);
  EXPECT_EQ(std::count(scan.value().ranges_m.begin(), scan.value().ranges_m.end(), LaserScan::kNoReturn),
            codes);
  EXPECT_EQ(scan.value().beam_period, std::chrono::nanoseconds(27778));
}

TEST(Lms1xxCapture, TheBinaryTelegramHas1141Ranges) {
  const std::string recorded = shared("lms5xx_lmdscandata_colab.bin");
  if (recorded.empty()) GTEST_SKIP() << "the recorded telegram is absent";
  Splitter splitter(Dialect::B);
  splitter.push(bytes_of(recorded));
  const auto payload = splitter.next();
  ASSERT_TRUE(payload);
  const auto data = decode_scan(Dialect::B, *payload);
  ASSERT_TRUE(data) << data.reason();
  const auto scan = to_laser_scan(data.value());
  ASSERT_TRUE(scan) << scan.reason();
  ASSERT_EQ(scan.value().ranges_m.size(), 1141U);
  EXPECT_EQ(scan.value().intensities.size(), 1141U);
  EXPECT_NEAR(to_deg(scan.value().angle_min_rad), -95.0, 1e-9);
  EXPECT_NEAR(to_deg(scan.value().angle_step_rad), 0.1667, 1e-9);
  EXPECT_FLOAT_EQ(scan.value().ranges_m[0], 1.305F);
}

TEST(Lms1xxCapture, TheRecordedRepliesAreUnderstood) {
  const std::string recorded = shared("lms5xx_colab_responses.txt");
  if (recorded.empty()) GTEST_SKIP() << "the recorded replies are absent";
  Splitter splitter(Dialect::B);
  Bytes stream;
  std::string digits;
  for (const char c : recorded)
    if (std::isxdigit(static_cast<unsigned char>(c)) != 0) {
      digits += c;
      if (digits.size() < 2) continue;
      stream.push_back(static_cast<std::uint8_t>(std::stoul(digits, nullptr, 16)));
      digits.clear();
    }
  splitter.push(stream);
  int replies = 0;
  std::vector<std::string> accepted;
  while (const auto payload = splitter.next()) {
    const auto head = head_of(*payload);
    ASSERT_TRUE(head);
    ++replies;
    if (head->kind == "sAN" && first_argument(Dialect::B, *head) == 1U) accepted.emplace_back(head->name);
  }
  EXPECT_EQ(replies, 50);
  EXPECT_EQ(splitter.damaged(), 0U);
  EXPECT_EQ(accepted, (std::vector<std::string>{"SetAccessMode", "Run"}));
}

TEST(Lms1xx, TheStartDialogueIsTheListings) {
  std::vector<std::string> lines;
  for (const Message& message : start_dialogue(false)) {
    const std::string framed = text_of(encode(Dialect::A, message));
    lines.push_back(framed.substr(1, framed.size() - 2));
  }
  EXPECT_EQ(lines, (std::vector<std::string>{"sMN SetAccessMode 03 F4724744",
                                             "sWN LMDscandatacfg 01 00 0 1 0 00 00 0 0 0 0 +1",
                                             "sMN LMCstartmeas", "sMN Run", "sEN LMDscandata 1"}));
  const Bytes login = encode(Dialect::B, start_dialogue(true)[0]);
  EXPECT_EQ(text_of(std::span(login).subspan(8, 18)), "sMN SetAccessMode ");
  EXPECT_EQ(Bytes(login.begin() + 26, login.end() - 1), (Bytes{0x03, 0xF4, 0x72, 0x47, 0x44}));
  const Bytes run = encode(Dialect::B, start_dialogue(true)[3]);  // no blank behind a name without arguments
  EXPECT_EQ(run, bytes_of(std::string("\x02\x02\x02\x02\0\0\0\x07sMN Run\x19", 16)));
}

/// As a device sends it: the code follows at once in binary, after a blank in text.
TEST(Lms1xx, ARefusalHasACodeAndNoName) {
  const Message refusal{"sFA", "", {{10, 2}}};
  const Bytes binary = bytes_of(std::string("\x02\x02\x02\x02\0\0\0\x05sFA\0\n~", 14));
  EXPECT_EQ(encode(Dialect::B, refusal), binary);
  EXPECT_EQ(text_of(encode(Dialect::A, refusal)), "\x02sFA A\x03");
  for (const Dialect dialect : {Dialect::A, Dialect::B}) {
    Splitter splitter(dialect);
    splitter.push(encode(dialect, refusal));
    const auto payload = splitter.next();
    ASSERT_TRUE(payload);
    const auto head = head_of(*payload);
    ASSERT_TRUE(head);
    EXPECT_EQ(head->kind, "sFA");
    EXPECT_EQ(head->name, "");
  }
}

TEST(Lms1xx, FiveEchoesWithRssiOf16BitsAreRead) {
  ScanData data = sample();
  for (const char kind : {'D', 'R'})
    for (char echo = '1'; echo <= '5'; ++echo) {
      Channel<std::uint16_t> channel = sample().channels16[0];
      channel.name = {kind == 'D' ? 'D' : 'R', kind == 'D' ? 'I' : 'S', 'S', kind == 'D' ? 'T' : 'I', echo};
      if (kind == 'D' && echo == '1') continue;  // sample() has it
      data.channels16.push_back(channel);
    }
  ASSERT_EQ(data.channels16.size(), 10U);
  for (const Dialect dialect : {Dialect::A, Dialect::B}) {
    Splitter splitter(dialect);
    splitter.push(encode(dialect, data));
    const auto payload = splitter.next();
    ASSERT_TRUE(payload);
    const auto read = decode_scan(dialect, *payload);
    ASSERT_TRUE(read) << read.reason();
    EXPECT_EQ(read.value(), data);
  }
}

/// Seconds of this thread's own time that a splitter needs for the bytes in such pieces.
double work_s(Dialect dialect, const Bytes& bytes, std::size_t piece) {
  const auto now_s = [] {
    timespec t{};
    (void)::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  const double start_s = now_s();
  Splitter splitter(dialect);
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    splitter.push(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
    while (splitter.next()) {
    }
  }
  return now_s() - start_s;
}

Bytes repeated(const Bytes& bytes, std::size_t length) {
  Bytes all;
  while (all.size() < length) all.insert(all.end(), bytes.begin(), bytes.end());
  return all;
}

/// Every eight bytes the head of a long frame whose check fails; a text that comes byte by byte and never
/// ends. Where each byte was looked at again and again, this took thousands of times as long as good
/// telegrams do.
TEST(Lms1xx, DamageCostsNoMoreThanGoodTelegrams) {
  const Bytes heads = repeated({2, 2, 2, 2, 0, 0, 0xFF, 0xF0}, 400'000);
  const Bytes scans = repeated(encode(Dialect::B, sample()), heads.size());
  EXPECT_LT(work_s(Dialect::B, heads, 16'384), 100.0 * work_s(Dialect::B, scans, 16'384));
  Bytes endless(130'000, 'x');
  endless[0] = endless[65'000] = 2;
  const Bytes answers = repeated(frame(Dialect::A, bytes_of("sAN Run 1")), endless.size());
  EXPECT_LT(work_s(Dialect::A, endless, 1), 30.0 * work_s(Dialect::A, answers, 1));
}

TEST(Lms1xx, AGoodTelegramIsFoundBehindManyFalseHeads) {
  Bytes line = repeated({2, 2, 2, 2, 0, 0, 0xFF, 0xF0}, 100'000);
  line.insert(line.end(), kMaxPayload, 0);
  const Bytes good = encode(Dialect::B, sample());
  line.insert(line.end(), good.begin(), good.end());
  Splitter splitter(Dialect::B);
  splitter.push(line);
  std::size_t last = 0;  // a false frame's check may fit by chance
  while (const auto payload = splitter.next()) last = payload->size();
  EXPECT_EQ(last, good.size() - 9);
}

TEST(Lms1xx, SplitterFindsTelegramsInAnyPiecesAfterNoise) {
  for (const Dialect dialect : {Dialect::A, Dialect::B})
    for (const std::size_t piece : {std::size_t{1}, std::size_t{100}, std::size_t{100'000}}) {
      Bytes line = bytes_of("noise\x02\x02noise");
      for (int i = 0; i < 3; ++i) {
        const Bytes telegram = encode(dialect, sample());
        line.insert(line.end(), telegram.begin(), telegram.end());
      }
      Splitter splitter(dialect);
      int found = 0;
      for (std::size_t at = 0; at < line.size(); at += piece) {
        splitter.push(std::span(line).subspan(at, std::min(piece, line.size() - at)));
        while (const auto payload = splitter.next()) {
          const auto data = decode_scan(dialect, *payload);
          ASSERT_TRUE(data);
          EXPECT_EQ(data.value(), sample());
          ++found;
        }
      }
      EXPECT_EQ(found, 3);
    }
}

TEST(Lms1xx, AWrongChecksumIsThrownAway) {
  Bytes line = encode(Dialect::B, sample());
  line[100] = static_cast<std::uint8_t>(line[100] ^ 1U);
  const Bytes good = encode(Dialect::B, sample());
  line.insert(line.end(), good.begin(), good.end());
  Splitter splitter(Dialect::B);
  splitter.push(line);
  ASSERT_TRUE(splitter.next());
  EXPECT_FALSE(splitter.next());
  EXPECT_GE(splitter.damaged(), 1U);
}

TEST(Lms1xx, DamagedTelegramsAreRefused) {
  const Bytes telegram = encode(Dialect::B, sample());
  const Bytes payload(telegram.begin() + 8, telegram.end() - 1);
  for (std::size_t length = 0; length + 10 < payload.size(); length += 13)
    EXPECT_FALSE(decode_scan(Dialect::B, std::span(payload).first(length))) << length;
  EXPECT_FALSE(decode_scan(Dialect::A, bytes_of("sSN LMDscandata 1 1 zz")));
  EXPECT_FALSE(decode_scan(Dialect::A, bytes_of("sSN LMDscandata 1 1 123456789")));
  EXPECT_FALSE(decode_scan(Dialect::A, bytes_of("sAN Run 1")));
  ScanData data = sample();
  data.channels16[0].scale = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(to_laser_scan(data));
  data.channels16.clear();
  EXPECT_FALSE(to_laser_scan(data));
}

}  // namespace
}  // namespace madori::sensors::lms1xx
