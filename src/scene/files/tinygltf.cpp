// The implementation in tinygltf's header. Its library is not linked: Debian's libdraco holds a tinygltf of
// its own, with another layout of its classes, and the linker would choose between the two by their order.
#define TINYGLTF_IMPLEMENTATION
#include <fstream>  // which the header forgets with TINYGLTF_NO_FS

#include <tiny_gltf.h>
