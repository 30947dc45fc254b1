#error \
    "This room is free of OpenGL (docs/architecture.md, The house): move what needs it to host/graphics, gpu or surface."
