#include "tartan_calib/io/corners_csv.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "support/expect_message.h"
#include "support/temporary_folder.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/atomic_file.h"

namespace tartan_calib::io {
namespace {

using observation::Corner;
using test_support::expectMessage;
using test_support::TemporaryFolder;

const std::string kHead =
    "# cam0 752 480 /cam0/image_raw\n# cam1 640 480 /cam1/image raw\n"
    "camera,stamp_ns,corner_id,u_px,v_px,cov_uu,cov_uv,cov_vv,used\n";

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Corner corner(int id, double u, double v) {
  Corner corner;
  corner.corner_id = id;
  corner.px = {u, v};
  return corner;
}

std::vector<pipeline::CameraCorners> example() {
  std::vector<pipeline::CameraCorners> cameras(2);
  cameras[0].topic = "/cam0/image_raw";
  cameras[0].width = 752;
  cameras[0].height = 480;
  cameras[1].topic = "/cam1/image raw";
  cameras[1].width = 640;
  cameras[1].height = 480;
  Corner known = corner(7, 0.1234567, 479.9999996);
  known.cov_px2 << 0.0125, -0.0031234567, -0.0031234567, 0.04;
  known.used = false;
  cameras[0].images = {{0, 1404733405732800000, {corner(0, -0.25, 12.0), known}},
                       {0, 1404733405832800000, {corner(3, 5, 6)}}};
  cameras[1].images = {{1, 1404733405732800001, {corner(143, 639.0, 0.0)}}};
  return cameras;
}

TEST(CornersCsv, IsWrittenByCameraStampAndId) {
  const TemporaryFolder folder;
  saveCorners(folder.file("corners.csv"), example());
  EXPECT_EQ(contentOf(folder.file("corners.csv")),
            kHead +
                "0,1404733405732800000,0,-0.250000,12.000000,1,0,1,1\n"
                "0,1404733405732800000,7,0.123457,480.000000,0.0125,-0.0031234567,0.04,0\n"
                "0,1404733405832800000,3,5.000000,6.000000,1,0,1,1\n"
                "1,1404733405732800001,143,639.000000,0.000000,1,0,1,1\n");
}

TEST(CornersCsv, EveryFieldSurvivesTheRoundTrip) {
  const TemporaryFolder folder;
  const std::vector<pipeline::CameraCorners> written = example();
  saveCorners(folder.file("corners.csv"), written);
  const std::vector<pipeline::CameraCorners> read = loadCorners(folder.file("corners.csv"));
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].topic, written[i].topic);
    EXPECT_EQ(read[i].width, written[i].width);
    EXPECT_EQ(read[i].height, written[i].height);
    EXPECT_EQ(read[i].num_images, written[i].images.size());
    ASSERT_EQ(read[i].images.size(), written[i].images.size());
    for (std::size_t k = 0; k < read[i].images.size(); ++k) {
      const observation::CameraView& a = read[i].images[k];
      const observation::CameraView& b = written[i].images[k];
      EXPECT_EQ(a.camera_index, b.camera_index);
      EXPECT_EQ(a.stamp_ns, b.stamp_ns);
      ASSERT_EQ(a.corners.size(), b.corners.size());
      for (std::size_t c = 0; c < a.corners.size(); ++c) {
        EXPECT_EQ(a.corners[c].corner_id, b.corners[c].corner_id);
        EXPECT_LE((a.corners[c].px - b.corners[c].px).cwiseAbs().maxCoeff(), 0.5000001e-6);
        EXPECT_TRUE(a.corners[c].cov_px2.isApprox(b.corners[c].cov_px2, 1e-8));
        EXPECT_EQ(a.corners[c].used, b.corners[c].used);
      }
    }
  }
}

TEST(CornersCsv, LinesMayComeInAnyOrderAndLackWhatTheDetectorDoesNotKnow) {
  const auto cameras = parseCorners(
      kHead + "1,20,5,1.5,2.5,,,,\r\n\n0,10,1,3,4,,,,\n# a remark\n1,20,4,1e2,2,,,,1\n1,10,4,1,2,,,,0", "c.csv");
  ASSERT_EQ(cameras[1].images.size(), 2U);
  EXPECT_EQ(cameras[1].images[0].stamp_ns, 10);
  EXPECT_FALSE(cameras[1].images[0].corners[0].used);
  EXPECT_EQ(cameras[1].images[1].corners[0].corner_id, 4);
  EXPECT_EQ(cameras[1].images[1].corners[0].px.x(), 100.0);
  EXPECT_EQ(cameras[1].images[1].corners[1].px.y(), 2.5);
  EXPECT_TRUE(cameras[1].images[1].corners[1].cov_px2.isIdentity());
  EXPECT_TRUE(cameras[1].images[1].corners[1].used);
}

TEST(CornersCsv, EveryMalformedLineIsNamedWithItsFile) {
  const auto expect_rejected = [](const std::string& text, std::initializer_list<std::string> parts) {
    SCOPED_TRACE(text);
    expectMessage<InputError>([&] { parseCorners(text, "c.csv"); }, parts);
  };
  const std::string good = "0,10,1,3,4,1,0,1,1\n";
  expect_rejected(kHead + good + "0,10,2,3,4,1,0,1\n", {"c.csv:5", "9 fields", "found 8"});
  expect_rejected(kHead + good + "0,10,2,3,4,1,0,1,1,\n", {"c.csv:5", "9 fields", "found 10"});
  expect_rejected(kHead + "cam0,10,1,3,4,1,0,1,1\n", {"c.csv:4", "camera", "'cam0'"});
  expect_rejected(kHead + "2,10,1,3,4,1,0,1,1\n", {"c.csv:4", "camera 2"});
  expect_rejected(kHead + "-1,10,1,3,4,1,0,1,1\n", {"c.csv:4", "camera -1"});
  expect_rejected(kHead + "0,1.5,1,3,4,1,0,1,1\n", {"c.csv:4", "stamp_ns", "'1.5'"});
  expect_rejected(kHead + "0,99999999999999999999,1,3,4,1,0,1,1\n", {"c.csv:4", "stamp_ns"});
  expect_rejected(kHead + "0,10,,3,4,1,0,1,1\n", {"c.csv:4", "corner_id", "''"});
  expect_rejected(kHead + "0,10,-1,3,4,1,0,1,1\n", {"c.csv:4", "corner_id"});
  expect_rejected(kHead + "0,10,1,x,4,1,0,1,1\n", {"c.csv:4", "u_px", "'x'"});
  expect_rejected(kHead + "0,10,1,3,,1,0,1,1\n", {"c.csv:4", "v_px", "''"});
  expect_rejected(kHead + "0,10,1,3,nan,1,0,1,1\n", {"c.csv:4", "v_px", "'nan'"});
  expect_rejected(kHead + "0,10,1,3 4,4,1,0,1,1\n", {"c.csv:4", "u_px", "'3 4'"});
  expect_rejected(kHead + "0,10,1,753,4,1,0,1,1\n", {"c.csv:4", "752x480"});
  expect_rejected(kHead + "0,10,1,3,-2,1,0,1,1\n", {"c.csv:4", "752x480"});
  expect_rejected(kHead + "0,10,1,3,4,1,,1,1\n", {"c.csv:4", "cov_uv"});
  expect_rejected(kHead + "0,10,1,3,4,1,2,1,1\n", {"c.csv:4", "covariance"});
  expect_rejected(kHead + "0,10,1,3,4,1,0,1,yes\n", {"c.csv:4", "used", "'yes'"});
  expect_rejected(kHead + good + good, {"c.csv", "corner 1 of cam0", "twice", "stamp 10"});
  expect_rejected("# cam0 752 /cam0\n", {"c.csv:1", "# cam<index> <width> <height> <topic>"});
  expect_rejected("# cam0 752 0 /cam0\n", {"c.csv:1", "# cam<index> <width> <height> <topic>"});
  expect_rejected("# cam1 752 480 /cam0\n", {"c.csv:1", "cam0"});
  expect_rejected("# cam0 752 480 /cam0\n# cam0 752 480 /cam0\n", {"c.csv:2", "cam1"});
  expect_rejected("# cam0 752 480 /cam0\n" + good, {"c.csv:2", "header"});
  expect_rejected("camera,stamp_ns,corner_id,u_px,v_px,cov_uu,cov_uv,cov_vv,used\n", {"c.csv:1", "before the header"});
  expect_rejected("", {"c.csv", "header"});
}

TEST(CornersCsv, AMissingFileIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("missing.csv");
  expectMessage<InputError>([&] { loadCorners(path); }, {path, "No such file or directory"});
}

}  // namespace
}  // namespace tartan_calib::io
