// Volumes by way of ITK (itk.org); nothing else of ours sees that library.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "lodestone/base/units.h"
#include "lodestone/io/volumes/dicom_stack_detail.h"
#include "lodestone/io/volumes/itk_detail.h"
#include "lodestone/io/volumes/plain_numbers_detail.h"

#ifdef LODESTONE_WITH_ITK
#include <itkGDCMImageIO.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkPNGImageIO.h>
#include <itkTIFFImageIO.h>
#endif

namespace lodestone::io::detail {
namespace fs = std::filesystem;

VoxelType type_for(const std::string& component) {
  if (component == "uint8") return VoxelType::uint8;
  if (component == "int8" || component == "int16") return VoxelType::int16;
  if (component == "uint16") return VoxelType::uint16;
  return VoxelType::float32;
}

#ifdef LODESTONE_WITH_ITK

namespace {

using IoPointer = itk::ImageIOBase::Pointer;

std::string component_name(itk::IOComponentEnum type) {
  switch (type) {
    case itk::IOComponentEnum::UCHAR:
      return "uint8";
    case itk::IOComponentEnum::CHAR:
      return "int8";
    case itk::IOComponentEnum::USHORT:
      return "uint16";
    case itk::IOComponentEnum::SHORT:
      return "int16";
    default:
      return "float32";
  }
}

// ITK's message without its place in ITK's source.
std::string reason_of(const std::exception& error) {
  std::string text = error.what();
  const std::size_t described = text.rfind("Description: ");
  if (described != std::string::npos) text.erase(0, described + 13);
  if (text.starts_with("ITK ERROR: ")) text.erase(0, 11);
  const std::size_t name = text.find("): ");
  if (name != std::string::npos && name < 60) text.erase(0, name + 3);
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "it can't be read" : text;
}

template <class Body>
Result<void> guarded(const fs::path& path, Body&& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::out_of_memory, "reading it needs more memory than there is", path.string());
  } catch (const itk::MemoryAllocationError&) {
    return fail(ErrorCode::out_of_memory, "reading it needs more memory than there is", path.string());
  } catch (const std::exception& error) {
    return fail(ErrorCode::bad_format, reason_of(error), path.string(), "is the file whole?");
  }
}

// The reader for a file by its ending or, for DICOM, its content; null where there is none.
IoPointer reader_for(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::vector<IoPointer> all{itk::NrrdImageIO::New().GetPointer(),  itk::MetaImageIO::New().GetPointer(),
                                   itk::NiftiImageIO::New().GetPointer(), itk::TIFFImageIO::New().GetPointer(),
                                   itk::PNGImageIO::New().GetPointer(),   itk::GDCMImageIO::New().GetPointer()};
  for (const IoPointer& io : all) {
    if (io->CanReadFile(path.c_str())) {
      io->SetFileName(path.string());
      io->ReadImageInformation();
      return io;
    }
  }
  return nullptr;
}

template <class T, unsigned N>
typename itk::Image<T, N>::Pointer read_image(const IoPointer& io, const fs::path& path) {
  auto reader = itk::ImageFileReader<itk::Image<T, N>>::New();
  reader->SetImageIO(io);
  reader->SetFileName(path.string());
  reader->Update();
  return reader->GetOutput();
}

// Hands the first volume of an image on, slice by slice.
template <class T, unsigned N>
Result<void> send_image(const IoPointer& io, const fs::path& path, const VolumeHeader& header, VoxelType type,
                        const VolumeSink& sink, const Task& task) {
  const auto image = read_image<T, N>(io, path);
  LODESTONE_TRY(sink.begin(header, type));
  const auto& size = header.grid.size;
  const std::size_t slice = std::size_t{size[0]} * size[1];
  const T* values = image->GetBufferPointer();
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    if (task.cancelled()) return cancelled_error("reading");
    const Result<void> sent = sink.slice(std::as_bytes(std::span(values + z * slice, slice)));
    if (!sent) return sent;
  }
  return {};
}

template <unsigned N>
Result<void> send(const IoPointer& io, const fs::path& path, const VolumeHeader& header, const VolumeSink& sink,
                  const Task& task) {
  const VoxelType type = type_for(component_name(io->GetComponentType()));
  switch (type) {
    case VoxelType::uint8:
      return send_image<std::uint8_t, N>(io, path, header, type, sink, task);
    case VoxelType::int16:
      return send_image<std::int16_t, N>(io, path, header, type, sink, task);
    case VoxelType::uint16:
      return send_image<std::uint16_t, N>(io, path, header, type, sink, task);
    case VoxelType::float32:
      break;
  }
  return send_image<float, N>(io, path, header, type, sink, task);
}

Vec3d vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

void set_columns(Mat4d& m, Vec3d x, Vec3d y, Vec3d z, Vec3d origin) {
  m.m = {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

// First voxel's centre at 0.
VoxelGrid grid_of(std::array<std::uint32_t, 3> size, Vec3d spacing) {
  return {size, {-0.5 * spacing.x, -0.5 * spacing.y, -0.5 * spacing.z}, spacing};
}

Result<void> check_sides(const fs::path& path, const itk::ImageIOBase& io) {
  if (io.GetNumberOfComponents() != 1) {
    return fail(ErrorCode::unsupported, fmt::format("has {} numbers a voxel (colours?)", io.GetNumberOfComponents()),
                path.string(), "extract one channel first");
  }
  if (io.GetNumberOfDimensions() < 3 || io.GetDimensions(2) < 2) {
    return fail(ErrorCode::unsupported, "is a single slice, not a volume", path.string(),
                "name the folder that holds all slices");
  }
  for (unsigned k = 0; k < 3; ++k) {
    if (io.GetDimensions(k) >= 1 && io.GetDimensions(k) <= 65'535) continue;
    return fail(ErrorCode::unsupported, fmt::format("has {} voxels along one side", io.GetDimensions(k)), path.string(),
                "65,535 can be read");
  }
  return {};
}

Result<VolumeHeader> header_of(const fs::path& path, const itk::ImageIOBase& io) {
  LODESTONE_TRY(check_sides(path, io));
  VolumeHeader header;
  Vec3d spacing, axes[3], origin;
  for (unsigned k = 0; k < 3; ++k) {
    spacing[k] = io.GetSpacing(k);
    origin[k] = io.GetOrigin(k);
    axes[k] = vector_of(io.GetDirection(k));
    if (!(spacing[k] > 0) || !std::isfinite(spacing[k]) || !std::isfinite(origin[k])) {
      return fail(ErrorCode::bad_format, "says of its voxels that their size or place is no number", path.string());
    }
  }
  header.grid =
      grid_of({static_cast<std::uint32_t>(io.GetDimensions(0)), static_cast<std::uint32_t>(io.GetDimensions(1)),
               static_cast<std::uint32_t>(io.GetDimensions(2))},
              spacing);
  set_columns(header.to_world, axes[0], axes[1], axes[2], origin);
  const std::string kind = io.GetNameOfClass();
  header.patient_axes = kind != "TIFFImageIO" && kind != "PNGImageIO";
  header.meters_per_unit = header.patient_axes ? 0.001 : 0;
  header.files = {path};
  std::uint64_t volumes = 1;
  for (unsigned k = 3; k < io.GetNumberOfDimensions(); ++k) volumes *= io.GetDimensions(k);
  if (volumes > 1) header.warnings.push_back(fmt::format("holds {} volumes, of which the first is read", volumes));
  return header;
}

// Backslash-separated numbers, each with blanks around it and perhaps a plus; none if one of them is no number.
std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    std::string_view word = text.substr(at, end - at);
    at = end + 1;
    word.remove_prefix(std::min(word.find_first_not_of(' '), word.size()));
    if (word.starts_with('+')) word.remove_prefix(1);
    const std::optional<LeadingNumber> number = leading_number(word);
    if (!number) return {};
    out.push_back(number->value);
  }
  return out;
}

std::string tag(const itk::GDCMImageIO& io, const char* key) {
  std::string value;
  if (!const_cast<itk::GDCMImageIO&>(io).GetValueFromTag(key, value)) return {};
  while (!value.empty() && (value.back() == ' ' || value.back() == '\0')) value.pop_back();
  return value;
}

DicomSlice slice_of(const fs::path& file, const itk::GDCMImageIO& io) {
  DicomSlice slice;
  slice.file = file.filename().string();
  slice.series = tag(io, "0020|000e");
  slice.description = tag(io, "0008|103e");
  slice.position = {io.GetOrigin(0), io.GetOrigin(1), io.GetOrigin(2)};
  const std::vector<double> place = numbers_of(tag(io, "0020|0032"));
  if (place.size() == 3) slice.position = vector_of(place);
  slice.row = vector_of(io.GetDirection(0));
  slice.column = vector_of(io.GetDirection(1));
  slice.spacing = {io.GetSpacing(0), io.GetSpacing(1)};
  slice.size = {static_cast<std::uint32_t>(io.GetDimensions(0)), static_cast<std::uint32_t>(io.GetDimensions(1))};
  return slice;
}

struct SeriesFiles {
  std::vector<DicomSlice> slices;
  std::vector<fs::path> files;  // one a slice
  std::vector<VoxelType> types;
};

Result<SeriesFiles> list_slices(const std::vector<fs::path>& files, const Task& task) {
  SeriesFiles out;
  for (const fs::path& file : files) {
    if (task.cancelled()) return cancelled_error("reading");
    auto io = itk::GDCMImageIO::New();
    if (!io->CanReadFile(file.c_str())) continue;
    const Result<void> listed = guarded(file, [&]() -> Result<void> {
      io->SetFileName(file.string());
      io->ReadImageInformation();
      if (io->GetNumberOfComponents() != 1) {
        return fail(ErrorCode::unsupported, "has colours, not one value a voxel", file.string());
      }
      out.slices.push_back(slice_of(file, *io));
      out.files.push_back(file);
      out.types.push_back(type_for(component_name(io->GetComponentType())));
      return {};
    });
    LODESTONE_TRY(listed);
  }
  return out;
}

Error with_place(Error error, const fs::path& place) {
  if (error.where.empty()) error.where = place.string();
  return error;
}

template <class T>
Result<void> send_slices(const SeriesFiles& all, const DicomStack& stack, const VolumeSink& sink, const Task& task) {
  for (const std::size_t i : stack.order) {
    if (task.cancelled()) return cancelled_error("reading");
    const Result<void> sent = guarded(all.files[i], [&]() -> Result<void> {
      const IoPointer io = itk::GDCMImageIO::New().GetPointer();
      const auto image = read_image<T, 3>(io, all.files[i]);
      const DicomSlice& slice = all.slices[i];
      const std::size_t count = std::size_t{slice.size[0]} * slice.size[1];
      if (image->GetBufferedRegion().GetNumberOfPixels() < count) {
        return fail(ErrorCode::bad_format, "has fewer values than its header says", all.files[i].string());
      }
      return sink.slice(std::as_bytes(std::span(image->GetBufferPointer(), count)));
    });
    if (!sent) return sent;
    task.advance(1.0 / static_cast<double>(stack.order.size()));
  }
  return {};
}

VolumeHeader header_of(const SeriesFiles& all, const DicomStack& stack) {
  const DicomSlice& first = all.slices[stack.order.front()];
  VolumeHeader header;
  const double step = length(stack.step);
  header.grid = grid_of({first.size[0], first.size[1], static_cast<std::uint32_t>(stack.order.size())},
                        {first.spacing[0], first.spacing[1], step});
  set_columns(header.to_world, first.row, first.column, stack.step / step, first.position);
  header.patient_axes = true;
  header.meters_per_unit = 0.001;
  header.slice_positions = stack.slice_positions;
  for (const std::size_t i : stack.order) header.files.push_back(all.files[i]);
  header.warnings = stack.warnings;
  return header;
}

}  // namespace

Result<void> read_itk_file(const fs::path& path, const VolumeSink& sink, const Task& task) {
  itk::Object::SetGlobalWarningDisplay(false);
  const PlainNumbers plain;
  return guarded(path, [&]() -> Result<void> {
    const IoPointer io = reader_for(path);
    if (io == nullptr) return fail(ErrorCode::bad_format, "is no volume of a format that we read", path.string());
    const Result<VolumeHeader> header = header_of(path, *io);
    LODESTONE_TRY(header);
    switch (io->GetNumberOfDimensions()) {
      case 3:
        return send<3>(io, path, *header, sink, task);
      case 4:
        return send<4>(io, path, *header, sink, task);
      case 5:
        return send<5>(io, path, *header, sink, task);
      default:
        break;
    }
    return fail(ErrorCode::unsupported, fmt::format("has {} dimensions", io->GetNumberOfDimensions()), path.string());
  });
}

Result<void> read_itk_series(const fs::path& folder, const std::vector<fs::path>& files, const std::string& series,
                             const VolumeSink& sink, const Task& task) {
  itk::Object::SetGlobalWarningDisplay(false);
  const PlainNumbers plain;
  const Result<SeriesFiles> all = list_slices(files, task);
  LODESTONE_TRY(all);
  if (all->files.empty()) return fail(ErrorCode::empty, "holds no DICOM slice", folder.string());
  if (all->files.size() == 1) return read_itk_file(all->files.front(), sink, task);  // many frames in one
  const Result<std::vector<std::size_t>> chosen = choose_series(all->slices, series);
  if (!chosen) return fail(with_place(chosen.error(), folder));
  const Result<DicomStack> stack = stack_slices(all->slices, *chosen);
  if (!stack) return fail(with_place(stack.error(), folder));
  VoxelType type = all->types[stack->order.front()];
  for (const std::size_t i : stack->order) {
    if (all->types[i] != type) type = VoxelType::float32;
  }
  LODESTONE_TRY(sink.begin(header_of(*all, *stack), type));
  switch (type) {
    case VoxelType::uint8:
      return send_slices<std::uint8_t>(*all, *stack, sink, task);
    case VoxelType::int16:
      return send_slices<std::int16_t>(*all, *stack, sink, task);
    case VoxelType::uint16:
      return send_slices<std::uint16_t>(*all, *stack, sink, task);
    case VoxelType::float32:
      break;
  }
  return send_slices<float>(*all, *stack, sink, task);
}

Result<void> read_itk_pictures(const std::vector<fs::path>& files, const VolumeSink& sink, const Task& task) {
  itk::Object::SetGlobalWarningDisplay(false);
  const PlainNumbers plain;
  std::array<std::uint32_t, 2> size{};
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (task.cancelled()) return cancelled_error("reading");
    const Result<void> sent = guarded(files[i], [&]() -> Result<void> {
      const IoPointer io = reader_for(files[i]);
      if (io == nullptr) return fail(ErrorCode::bad_format, "is no picture that we read", files[i].string());
      if (io->GetNumberOfComponents() != 1) {
        return fail(ErrorCode::unsupported, "has colours, but slices have one value a voxel", files[i].string(),
                    "convert the slices to grey");
      }
      const std::array<std::uint32_t, 2> own{static_cast<std::uint32_t>(io->GetDimensions(0)),
                                             static_cast<std::uint32_t>(io->GetDimensions(1))};
      if (i == 0) {
        size = own;
        VolumeHeader header;
        header.grid = grid_of({own[0], own[1], static_cast<std::uint32_t>(files.size())},
                              {io->GetSpacing(0), io->GetSpacing(1), io->GetSpacing(0)});
        header.files = files;
        header.warnings.push_back("pictures don't say how far slices are apart: as far as voxels in them");
        LODESTONE_TRY(sink.begin(header, VoxelType::uint16));
      }
      if (own != size) {
        return fail(ErrorCode::bad_format,
                    fmt::format("is {} x {}, the slices before it are {} x {}", own[0], own[1], size[0], size[1]),
                    files[i].string());
      }
      const auto image = read_image<std::uint16_t, 2>(io, files[i]);
      return sink.slice(std::as_bytes(std::span(image->GetBufferPointer(), std::size_t{own[0]} * own[1])));
    });
    if (!sent) return sent;
    task.advance(1.0 / static_cast<double>(files.size()));
  }
  return {};
}

#else

namespace {
tl::unexpected<Error> not_built_in(const fs::path& path) {
  return fail(ErrorCode::unsupported, "reading volumes of this format is not built in", path.string(),
              "build with LODESTONE_WITH_ITK=ON (libinsighttoolkit5-dev), or convert it to bare values (`raw`)");
}
}  // namespace

Result<void> read_itk_file(const fs::path& path, const VolumeSink&, const Task&) { return not_built_in(path); }
Result<void> read_itk_series(const fs::path& folder, const std::vector<fs::path>&, const std::string&,
                             const VolumeSink&, const Task&) {
  return not_built_in(folder);
}
Result<void> read_itk_pictures(const std::vector<fs::path>& files, const VolumeSink&, const Task&) {
  return not_built_in(files.front());
}

#endif

}  // namespace lodestone::io::detail
