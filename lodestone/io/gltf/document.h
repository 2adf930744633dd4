// The glTF document behind a Model: everything that a .gltf or .glb holds, so that what we don't understand comes out
// as it went in. Immutable; its content is known to io/gltf*.cpp alone (gltf_detail.h).
#pragma once

#include <cstddef>
#include <memory>

namespace lodestone::io {

/// JSON, the bytes of all buffers and of the external images that the JSON names. Shared by all models made from one
/// file.
class Document {
 public:
  struct Data;
  explicit Document(std::unique_ptr<const Data> data);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  const Data& data() const { return *data_; }

  std::size_t node_count() const;
  std::size_t material_count() const;
  std::size_t animation_count() const;
  std::size_t skin_count() const;

 private:
  std::unique_ptr<const Data> data_;
};

}  // namespace lodestone::io
