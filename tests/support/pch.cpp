// Only here so that the precompiled header, which every test reuses, has a source to be built with.
