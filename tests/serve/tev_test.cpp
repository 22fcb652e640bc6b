// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// render --tev against a test viewer that parses packets as described in tev's README and source.
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <cstring>
#include <map>
#include <thread>
#include <vector>

#include "../cli/cli_fixture.h"
#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "socket.h"
#include "tev.h"

namespace lanthorn::tev_test {

using namespace program;
using namespace std::chrono_literals;

class PacketReader {
 public:
  explicit PacketReader(const std::string& bytes) : bytes_(bytes) { EXPECT_EQ(number<std::uint32_t>(), bytes.size()); }
  template <class Number>
  Number number() {
    Number value{};
    if (at_ + sizeof(value) <= bytes_.size()) std::memcpy(&value, bytes_.data() + at_, sizeof(value));
    at_ += sizeof(value);
    return value;
  }
  std::string text() {
    std::string result = bytes_.c_str() + at_;
    at_ += result.size() + 1;
    return result;
  }
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

// The picture of the viewer.
struct Viewer {
  std::string name;
  Image image;
  int creations = 0, updates = 0;

  void take(const std::string& packet) {
    PacketReader in(packet);
    const auto operation = in.number<std::uint8_t>();
    in.number<std::uint8_t>();  // focus
    name = in.text();
    if (operation == 4) return create(in);
    ASSERT_EQ(operation, 6);
    update(in);
  }
  void create(PacketReader& in) {
    const auto width = in.number<std::int32_t>(), height = in.number<std::int32_t>(), count = in.number<std::int32_t>();
    std::vector<std::string> channels;
    for (int i = 0; i < count; ++i) channels.push_back(in.text());
    image = Image(width, height, channels);
    EXPECT_TRUE(in.is_at_end());
    ++creations;
  }
  void update(PacketReader& in) {
    const auto count = in.number<std::int32_t>();
    std::vector<std::string> channels;
    for (int i = 0; i < count; ++i) channels.push_back(in.text());
    ASSERT_EQ(channels, image.channels);
    const auto x = in.number<std::int32_t>(), y = in.number<std::int32_t>(), width = in.number<std::int32_t>(),
               height = in.number<std::int32_t>();
    for (int i = 0; i < count; ++i) ASSERT_EQ(in.number<std::int64_t>(), i);
    for (int i = 0; i < count; ++i) ASSERT_EQ(in.number<std::int64_t>(), count);
    ASSERT_TRUE(x == 0 && width == image.width && y >= 0 && y + height <= image.height);
    for (std::size_t i = image.index(0, y); i < image.index(0, y + height); ++i) image.pixels[i] = in.number<float>();
    EXPECT_TRUE(in.is_at_end());
    ++updates;
  }
};

Image numbered(int width, int height) {
  Image image(width, height, {"R", "G", "B", "depth.Z"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  return image;
}

TEST(TevPackets, APictureArrivesAsItWas) {
  const Image image = numbered(5, 4);
  Viewer viewer;
  viewer.take(tev_create_image("a.exr", image));
  viewer.take(tev_update_rows("a.exr", image, 0, 3));
  viewer.take(tev_update_rows("a.exr", image, 3, 1));
  EXPECT_EQ(viewer.name, "a.exr");
  EXPECT_EQ(viewer.image.pixels, image.pixels);
}

TEST(TevPackets, AddressesOfViewers) {
  EXPECT_EQ(parse_host_port("box:1", "--tev").host, "box");
  EXPECT_EQ(parse_host_port("box:1", "--tev").port, 1);
  EXPECT_EQ(parse_host_port("box", "--tev").port, 14158);
  EXPECT_EQ(parse_host_port("[::1]:7", "--tev").host, "::1");
  for (const char* wrong : {"", ":1", "box:", "box:x", "box:0", "box:65536"})
    EXPECT_THROW(parse_host_port(wrong, "--tev"), Error) << wrong;
}

// Accepts one connection and reads packets until it ends.
class TestViewer {
 public:
  explicit TestViewer(int most_packets = 1 << 30)
      : listener_(listen_at("127.0.0.1", 0, 1)), thread_([this, most_packets] { work(most_packets); }) {}

  std::string address() const { return "127.0.0.1:" + std::to_string(port_of(listener_)); }
  Viewer& finished() {
    thread_.join();
    return viewer_;
  }

 private:
  void work(int most_packets) {
    FileDescriptor socket(::accept(listener_.get(), nullptr, nullptr));
    const Connection connection(std::move(socket), nullptr);
    std::string bytes;
    for (int count = 0; count < most_packets; ++count) {
      std::uint32_t size = 4;
      while (bytes.size() < size || (std::memcpy(&size, bytes.data(), 4), bytes.size() < size))
        if (!connection.read_some(bytes, 1 << 20, std::chrono::steady_clock::now() + 60s)) return;
      viewer_.take(bytes.substr(0, size));
      bytes.erase(0, size);
    }
  }

  FileDescriptor listener_;
  Viewer viewer_;
  std::thread thread_;
};

using Tev = Cli;

TEST_F(Tev, TheViewerHasTheFinishedPictureWithAllLayers) {
  TestViewer viewer;
  const Ending ending = succeed(render({"-p", "4", "-o", "a.exr", "--tev", viewer.address()}));
  const Viewer& seen = viewer.finished();
  EXPECT_EQ(seen.name, "a.exr");
  EXPECT_EQ(seen.creations, 1);
  EXPECT_GE(seen.updates, 1);
  const Image rendered = with_denoised_light(read_image(path("a.exr")));  // without the layers for a denoiser
  ASSERT_EQ(seen.image.channel_count(), rendered.channel_count());
  for (std::size_t c = 0; c < rendered.channel_count(); ++c) {  // files order them differently
    const auto channel = seen.image.find_channel(rendered.channels[c]);
    ASSERT_TRUE(channel) << rendered.channels[c];
    for (int y = 0; y < rendered.height; ++y)
      for (int x = 0; x < rendered.width; ++x) ASSERT_EQ(seen.image.at(x, y, *channel), rendered.at(x, y, c));
  }
  EXPECT_EQ(ending.err, "");
}

TEST_F(Tev, NamesOfFilesDoNothingToTheViewersTerminal) {
  TestViewer viewer;
  succeed(render({"-p", "1", "-o", "a\x1b[31m\x7f.exr", "--tev", viewer.address()}));
  EXPECT_EQ(viewer.finished().name, "a\\x1b[31m\\x7f.exr");
}

TEST_F(Tev, AViewerThatIsNotThereOrGoesAwayIsAWarning) {
  succeed(render({"-p", "2", "-o", "alone.exr"}));
  const Ending absent = succeed(render({"-p", "2", "-o", "absent.exr", "--tev", "127.0.0.1:1"}));
  EXPECT_TRUE(contains(absent.err, "--tev: cannot connect to 127.0.0.1 port 1")) << absent.err;
  expect_equal_files("alone.exr", "absent.exr");
  TestViewer viewer(/*most_packets=*/1);
  succeed(render({"-p", "2", "-o", "gone.exr", "--tev", viewer.address()}));
  viewer.finished();
  expect_equal_files("alone.exr", "gone.exr");
  refuse(render({"-o", "a.exr", "--tev", "box:x"}), "--tev box:x: expected HOST:PORT");
}

}  // namespace lanthorn::tev_test
