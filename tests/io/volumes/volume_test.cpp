#include "lodestone/io/volumes/read.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "lodestone/io/volumes/dicom_stack_detail.h"
#include "support/comma_locale.h"
#include "support/folder.h"
#include "support/shapes.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;
using detail::DicomSlice;

DicomSlice slice(const std::string& file, double z, const std::string& series = "1") {
  DicomSlice s;
  s.file = file;
  s.series = series;
  s.position = {-10, -20, z};
  s.row = {1, 0, 0};
  s.column = {0, 1, 0};
  s.spacing = {0.5, 0.5};
  s.size = {64, 64};
  return s;
}

std::vector<std::size_t> all(std::size_t n) {
  std::vector<std::size_t> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = i;
  return out;
}

TEST(DicomStack, is_ordered_by_place_not_by_name) {
  const std::vector<DicomSlice> slices{slice("a", 5), slice("b", 0), slice("c", 2.5)};
  const auto stack = detail::stack_slices(slices, all(3));
  ASSERT_TRUE(stack);
  EXPECT_EQ(stack->order, (std::vector<std::size_t>{1, 2, 0}));
  EXPECT_NEAR(stack->step.z, 2.5, 1e-12);
  EXPECT_TRUE(stack->slice_positions.empty() && stack->warnings.empty());
}

TEST(DicomStack, tells_missing_slices) {
  const std::vector<DicomSlice> slices{slice("a", 0), slice("b", 5), slice("c", 10), slice("d", 20)};
  const auto stack = detail::stack_slices(slices, all(4));
  ASSERT_FALSE(stack);
  EXPECT_NE(stack.error().what.find("10 mm between c and d"), std::string::npos) << stack.error().what;
}

TEST(DicomStack, keeps_uneven_slices_where_they_are) {
  const std::vector<DicomSlice> slices{slice("a", 0), slice("b", 2), slice("c", 5), slice("d", 7)};
  const auto stack = detail::stack_slices(slices, all(4));
  ASSERT_TRUE(stack);
  EXPECT_EQ(stack->slice_positions, (std::vector<double>{0, 2, 5, 7}));
  EXPECT_EQ(stack->warnings.size(), 1U);
}

TEST(DicomStack, shears_with_a_tilted_gantry) {
  std::vector<DicomSlice> slices{slice("a", 0), slice("b", 5), slice("c", 10)};
  const double c = std::cos(0.3), s = std::sin(0.3);
  for (DicomSlice& one : slices) one.column = {0, c, -s};
  const auto stack = detail::stack_slices(slices, all(3));
  ASSERT_TRUE(stack);
  EXPECT_NEAR(stack->step.z, 5, 1e-12);  // along the table, not along the normal
  ASSERT_EQ(stack->warnings.size(), 1U);
  EXPECT_NE(stack->warnings[0].find("tilted"), std::string::npos);
}

TEST(DicomStack, leaves_doubles_out_and_refuses_several_times) {
  const std::vector<DicomSlice> doubled{slice("a", 0), slice("b", 1), slice("b2", 1), slice("c", 2)};
  const auto stack = detail::stack_slices(doubled, all(4));
  ASSERT_TRUE(stack);
  EXPECT_EQ(stack->order, (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_EQ(stack->warnings.size(), 1U);
  const std::vector<DicomSlice> times{slice("a", 0), slice("a2", 0), slice("b", 1), slice("b2", 1)};
  EXPECT_FALSE(detail::stack_slices(times, all(4)));
  EXPECT_FALSE(detail::stack_slices(doubled, all(1))) << "one slice is no volume";
}

TEST(DicomStack, lists_several_series) {
  std::vector<DicomSlice> slices{slice("a", 0, "1.2"), slice("b", 1, "1.2"), slice("c", 0, "1.3"),
                                 slice("d", 1, "1.3")};
  const auto none = detail::choose_series(slices, "");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("1.3"), std::string::npos);
  EXPECT_EQ(*detail::choose_series(slices, "2"), (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(*detail::choose_series(slices, "1.2"), (std::vector<std::size_t>{0, 1}));
  EXPECT_FALSE(detail::choose_series(slices, "3"));
  // Two directions under one UID are two.
  slices[3].row = {0, 1, 0};
  slices[3].column = {0, 0, 1};
  EXPECT_FALSE(detail::choose_series(slices, "1.3"));
  EXPECT_EQ(*detail::choose_series(slices, "3"), (std::vector<std::size_t>{3}));
}

class VolumeFiles : public test::InFolder {
 protected:
  fs::path write(const std::string& name, const std::string& bytes) {
    const fs::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
};

TEST_F(VolumeFiles, raw_values_of_either_order) {
  std::string bytes;
  for (int i = 0; i < 24; ++i) bytes += {static_cast<char>(i / 10), static_cast<char>(i)};
  const fs::path path = write("v.raw", "head" + bytes);
  VolumeReadOptions options;
  options.raw = RawLayout{{2, 3, 4}, "int16", true, 4, {1, 2, 3}};
  const auto volume = read_volume(path, options);
  ASSERT_TRUE(volume) << volume.error().what;
  const auto values = std::get<std::span<const std::int16_t>>(volume->values);
  ASSERT_EQ(values.size(), 24U);
  EXPECT_EQ(values[23], 2 * 256 + 23);
  EXPECT_EQ(volume->header.grid.spacing, (Vec3d{1, 2, 3}));
  options.raw->size = {2, 3, 5};
  const auto longer = read_volume(path, options);
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().code, ErrorCode::bad_format);
  options.raw = RawLayout{{2, 3, 3}, "int16", true, 0, {1, 1, 1}};
  EXPECT_FALSE(read_volume(path, options)) << "more values than told";
  options.raw->type = "int24";
  EXPECT_FALSE(read_volume(path, options));
}

std::string nifti2(std::array<std::int64_t, 5> dims, std::int16_t type, std::size_t values_bytes) {
  std::string h(544, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(h.data() + at, &value, sizeof value); };
  put(0, std::int32_t{540});
  std::memcpy(h.data() + 4, "n+2\0\r\n\x1a\n", 8);
  put(12, type);
  put(16, std::int64_t{4});
  for (std::size_t k = 0; k < 4; ++k) put(24 + 8 * k, dims[k]);
  for (std::size_t k = 4; k < 7; ++k) put(24 + 8 * k, std::int64_t{1});
  for (std::size_t k = 0; k < 4; ++k) put(112 + 8 * k, 2.0);
  put(168, std::int64_t{544});
  put(348, std::int32_t{1});
  const double rows[3][4] = {{2, 0, 0, 10}, {0, 2, 0, 20}, {0, 0, 2, 30}};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 4; ++c) put(400 + 32 * r + 8 * c, rows[r][c]);
  }
  return h + std::string(values_bytes, '\5');
}

TEST_F(VolumeFiles, nifti_2_is_read_and_turned_to_the_patients_axes) {
  const auto volume = read_volume(write("a.nii", nifti2({3, 4, 5, 2, 0}, 2, 120)));
  ASSERT_TRUE(volume) << volume.error().what;
  EXPECT_EQ(volume->header.grid.size, (std::array<std::uint32_t, 3>{3, 4, 5}));
  EXPECT_EQ(std::get<std::span<const std::uint8_t>>(volume->values).size(), 60U);
  const Vec3d first = volume->header.to_world.point({0, 0, 0});
  EXPECT_EQ(first, (Vec3d{-10, -20, 30}));  // NIfTI counts to the right and to the front
  EXPECT_EQ(volume->header.warnings.size(), 1U) << "two volumes in it";
}

TEST_F(VolumeFiles, damaged_nifti_2_is_refused) {
  const std::string good = nifti2({3, 4, 5, 1, 0}, 2, 60);
  for (const std::size_t cut : {12U, 100U, 543U, 560U, 603U}) {
    EXPECT_FALSE(read_volume(write("cut.nii", good.substr(0, cut)))) << cut;
  }
  EXPECT_FALSE(read_volume(write("side.nii", nifti2({3, -4, 5, 1, 0}, 2, 60))));
  EXPECT_FALSE(read_volume(write("huge.nii", nifti2({3, 4, std::int64_t{1} << 40, 1, 0}, 2, 60))));
  EXPECT_FALSE(read_volume(write("type.nii", nifti2({3, 4, 5, 1, 0}, 1792, 60))));
  EXPECT_FALSE(read_volume(write("flat.nii", nifti2({3, 4, 1, 1, 0}, 2, 60))));
  EXPECT_FALSE(read_volume(folder_ / "not there.nii"));
}

TEST_F(VolumeFiles, a_program_with_a_decimal_comma_moves_no_voxel) {
  const std::string values(60, '\5');
  const fs::path nrrd = write("a.nrrd",
                              "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 4 5\nspace: left-posterior-superior\n"
                              "encoding: raw\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,2.5)\n"
                              "space origin: (0.25,0,100.75)\n\n" +
                                  values);
  write("a.zraw", values);
  const fs::path meta = write("a.mhd",
                              "ObjectType = Image\nNDims = 3\nDimSize = 3 4 5\nElementSpacing = 0.5 0.5 2.5\n"
                              "Offset = 0.25 0 100.75\nElementType = MET_UCHAR\nElementDataFile = a.zraw\n");
  const test::CommaLocale comma;
  for (const fs::path& path : {nrrd, meta}) {
    const auto volume = read_volume(path);
    if (!volume && volume.error().code == ErrorCode::unsupported) GTEST_SKIP() << "built without ITK";
    ASSERT_TRUE(volume) << volume.error().line();
    EXPECT_EQ(volume->header.grid.spacing, (Vec3d{0.5, 0.5, 2.5})) << path;
    EXPECT_EQ(volume->header.to_world.point({0, 0, 0}), (Vec3d{0.25, 0, 100.75})) << path;
  }
  EXPECT_EQ(std::use_facet<std::numpunct<char>>(std::locale()).decimal_point(), ',') << "the program's own stays";
  if (comma.of_c()) {
    EXPECT_STREQ(std::localeconv()->decimal_point, ",");
  }
}

TEST_F(VolumeFiles, folders_and_names) {
  EXPECT_TRUE(is_volume_name("a.NII.gz"));
  EXPECT_TRUE(is_volume_name("x/b.mha"));
  EXPECT_FALSE(is_volume_name("a.gz"));
  EXPECT_FALSE(is_volume_name("a.ply"));
  EXPECT_FALSE(is_volume_folder(folder_));
  write("1.png", "no picture");
  write("2.png", "no picture");
  EXPECT_TRUE(is_volume_folder(folder_));
  write("a.ply", "ply");
  EXPECT_FALSE(is_volume_folder(folder_)) << "models with their textures";
}

}  // namespace
}  // namespace lodestone::io
