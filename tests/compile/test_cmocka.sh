#!/usr/bin/env bash
# The other kinds of tests need cmocka.
echo 1..1
if "$PKG_CONFIG" --exists cmocka; then echo "ok 1 - cmocka"; else echo "ok 1 - cmocka # SKIP not found: only these tests ran"; fi
