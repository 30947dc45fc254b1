#pragma once

#include <functional>
#include <string>

#include <epoxy/gl.h>

#include "host/api/error.h"
#include "host/graphics/shader_template.h"

namespace meridian::graphics {

/// What a program is made of. Uniforms, blocks and samplers have explicit locations and bindings in the text: nothing
/// is looked up by name.
struct ProgramDescription {
  std::string key;  ///< equal keys mean equal programs
  ShaderSource vertex;
  ShaderSource fragment;

  /// Draws with the program as frames will: the same formats, filters, blending and depth state, a few pixels are
  /// enough; drivers make their machine code at the first draw of each such variant, not at the link.
  ///
  /// Called on the warm-up thread with the second context current, the program in use and the default state set. It
  /// makes all that it needs (targets, textures without contents, vertex arrays) and deletes it again; it must not
  /// touch objects of the first context and must not upload texels (llvmpipe crashes): glClearTexImage counts as
  /// uploading, glClearNamedFramebuffer does not. It is called again, on another context,
  /// when it had something compiled. Empty: nothing to warm.
  std::function<void(GLuint program)> warmUp;
};

/// Compiles and links with the context that is current. Errors: what the compiler says, with template file and line.
[[nodiscard]] Result<GLuint> compileProgram(const ProgramDescription& description);

}  // namespace meridian::graphics
