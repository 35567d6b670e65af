# What the zip must not hold, and the platform that it is for. FOLDER: the staged add-on; PLATFORM: linux-x64.
file(GLOB_RECURSE caches LIST_DIRECTORIES TRUE ${FOLDER}/*)
list(FILTER caches INCLUDE REGEX "/__pycache__$")
foreach(cache IN LISTS caches)
  file(REMOVE_RECURSE ${cache})
endforeach()
file(READ ${FOLDER}/blender_manifest.toml manifest)
string(REGEX REPLACE "platforms = \\[[^]]*\\]" "platforms = [\"${PLATFORM}\"]" manifest "${manifest}")
file(WRITE ${FOLDER}/blender_manifest.toml "${manifest}")
