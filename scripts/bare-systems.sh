# Sourced by scripts that try things on bare systems, made by debootstrap with the mirrors and the proxy of
# this system's apt. Ubuntu's releases need its archive keys: the package ubuntu-keyring, which Debian 12
# lacks, or what scripts/python-headers has fetched. `root` is the folder of the checkout.

in_chroot() {  # folder command...
    local folder=$1
    shift
    chroot "$folder" env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        ${http_proxy:+"http_proxy=$http_proxy"} ${https_proxy:+"https_proxy=$https_proxy"} \
        ${no_proxy:+"no_proxy=$no_proxy"} "$@"
}

# The first of this system's apt mirrors with that label, or the second argument.
mirror_of() {  # label otherwise
    local found
    found=$(apt-get indextargets --format '$(LABEL) $(REPO_URI)' 'Created-By: Packages' |
        sed -n "s/^$1 //p" | head -n 1) || true
    echo "${found:-$2}"
}

is_ubuntu() {  # release
    [[ ! $1 =~ ^(bookworm|trixie|forky|sid|testing|stable)$ ]]
}

# Ends the script with 77, and why, where this user, system or network cannot make and enter bare systems.
require_bare_systems() {  # release or folder...
    local why='' place release mirror
    place=$(mktemp -d)
    if ((EUID != 0)); then
        why="bare systems need root"
    elif ! command -v debootstrap >/dev/null; then
        why="debootstrap is missing: scripts/install-packages --release"
    elif ! mknod "$place/null" c 1 3 2>/dev/null || ! mount -t proc proc "$place" 2>/dev/null; then
        why="this root may not make devices and mount, as in a container without privileges"
    else
        umount "$place"
    fi
    rm -rf --one-file-system "$place"
    for release in "$@"; do
        [[ -z $why && ! -d $release ]] || break
        mirror=$(mirror_of Debian http://deb.debian.org/debian)
        ! is_ubuntu "$release" || mirror=$(mirror_of Ubuntu http://archive.ubuntu.com/ubuntu)
        wget --quiet --spider --timeout=20 --tries=2 "${mirror%/}/dists/$release/Release" ||
            why="there is no ${mirror%/}/dists/$release/Release: is there a network?"
    done
    if [[ -n $why ]]; then
        echo "$(basename "$0"): $why" >&2
        exit 77
    fi
}

make_bare_system() {  # release folder
    local release=$1 folder=$2 mirror security
    local keys=/usr/share/keyrings/ubuntu-archive-keyring.gpg
    [[ -e $keys ]] || keys=$root/build/python-headers$keys
    if is_ubuntu "$release"; then
        mirror=$(mirror_of Ubuntu http://archive.ubuntu.com/ubuntu)
        # gutsy: the script for all of Ubuntu's releases since; Debian lacks those of the latest.
        debootstrap --variant=minbase --components=main,universe \
            --keyring="$keys" \
            "$release" "$folder" "$mirror" gutsy
        printf 'deb %s %s main universe\n' "$mirror" "$release" "$mirror" "$release-updates" \
            "$mirror" "$release-security" >"$folder/etc/apt/sources.list"
    else
        mirror=$(mirror_of Debian http://deb.debian.org/debian)
        security=$(mirror_of Debian-Security http://deb.debian.org/debian-security)
        debootstrap --variant=minbase "$release" "$folder" "$mirror"
        printf 'deb %s %s main\n' "$mirror" "$release" "$mirror" "$release-updates" \
            "$security" "$release-security" >"$folder/etc/apt/sources.list"
    fi
    apt-config dump | grep -E '^Acquire::(https?::|Check-(Valid-Until|Date) )' \
        >"$folder/etc/apt/apt.conf.d/90host" || true
}
