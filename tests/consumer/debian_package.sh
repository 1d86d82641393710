#!/usr/bin/env bash
# debian_package.sh BUILD [--install-on-bare-system]: makes the Debian package of a build and checks what is in it; then, as
# root and with debootstrap, installs it with apt on a Debian that has nothing else, and packs a solid there.
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "cpack"; }
package=$(echo "$work"/innersphere_*.deb)
dpkg-deb --info "$package"
dpkg-deb --contents "$package" >"$work/contents"
for file in usr/bin/innersphere usr/include/innersphere/packing_shape.hpp usr/share/doc/innersphere/LICENSE \
  usr/share/doc/innersphere/copyright usr/share/doc/innersphere/README.md usr/share/doc/innersphere/plugin/README.md \
  usr/share/doc/innersphere/examples/hello_bullet.cpp '.*/pkgconfig/innersphere.pc' '.*/cmake/InnerSphere/InnerSphereConfig.cmake' \
  '.*/libinnersphere_plugin\.\(a\|so\)'; do
  grep -q " \./$file$" "$work/contents" || fail "the package has no $file"
done
grep -v ' root/root ' "$work/contents" && fail "not all files belong to root"
grep -vE ' \./(usr/(bin|include|lib|share)?.*)?$' "$work/contents" && fail "files outside of /usr"
field() { dpkg-deb --field "$package" "$1"; }
[ "$(field Package)" = innersphere ] || fail "the name is $(field Package)"
[ "$(field Maintainer)" = "InnerSphere developers" ] || fail "the maintainer is $(field Maintainer)"
[ "$(field Section)" = science ] || fail "the section is $(field Section)"
for library in libc6 libtbb libassimp libembree libbullet libpng; do
  field Depends | grep -q "$library" || fail "$library is missing in Depends: $(field Depends)"
done

[ "${2:-}" = --install-on-bare-system ] || exit 0
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
  echo "skipped: a bare system needs root and debootstrap"
  exit 77
fi
# The system that the package was built for: what it depends on has other names elsewhere.
# shellcheck disable=SC1091  # it is on every Debian
codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
bare=$work/bare
debootstrap --variant=minbase "$codename" "$bare" >"$work/log" 2>&1 || { tail "$work/log" >&2; fail "debootstrap"; }
for file in /etc/resolv.conf /etc/apt/apt.conf.d/*proxy*; do
  if [ -e "$file" ]; then cp "$file" "$bare$file"; fi
done
cp "$package" "$bare/innersphere.deb"
chroot "$bare" /bin/sh -euc '
  export DEBIAN_FRONTEND=noninteractive
  apt-get -qq update
  apt-get -qq install -y --no-install-recommends /innersphere.deb >/log 2>&1 || { tail /log; exit 1; }
  innersphere --version
  innersphere pack torus --spheres 200 -o /torus.cbor
  innersphere check /torus.cbor
' || fail "it does not run on a bare system"
echo "installed and run on a bare $codename"
