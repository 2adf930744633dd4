// lod-read-volume: reads a volume through other people's libraries, apart from the command that started it, so that a
// crash or a hang there is an ordinary error here. Values go to a file, all else to the pipe that it was given.
#include <new>

#include "app/children/volume_report.h"
#include "lodestone/base/file.h"
#include "lodestone/base/parallel.h"

namespace lodestone::app {
namespace {

Result<void> read(const VolumeWords& words) {
  Result<OutputFile> file = OutputFile::create(words.values);
  LODESTONE_TRY(file);
  io::VolumeSink sink;
  sink.begin = [](const VolumeHeader& header, io::VoxelType type) -> Result<void> {
    say_volume(header, type);
    return {};
  };
  sink.slice = [&](std::span<const std::byte> values) -> Result<void> {
    file->write(values);
    if (!file->failed()) return {};
    return fail(ErrorCode::cannot_write, "its values have no room there", words.values.parent_path().string(),
                "set TMPDIR to a folder with more");
  };
  const Result<void> done = io::read_volume(words.volume, words.options, sink);
  if (!done) return done;
  return file->commit();
}

}  // namespace
}  // namespace lodestone::app

int main(int argc, char** argv) {
  using namespace lodestone;
  const Result<app::VolumeWords> words = app::parse_volume_words({argv, argv + argc});
  Error error;
  try {
    const Result<void> done = words ? app::read(*words) : Result<void>(fail(words.error()));
    if (done) {
      app::say_done();
      return 0;
    }
    error = done.error();
  } catch (const std::bad_alloc&) {
    error = Error{ErrorCode::out_of_memory,
                  "reading it needs more memory than it may take",
                  words ? words->volume.string() : std::string(),
                  {}};
  }
  app::say_failed(error);
  return 1;
}
