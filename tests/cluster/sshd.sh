# For tests that source it: a server of ssh in the current folder, and the settings by which it is reached.

# sshd_up ADDRESS: starts a server that has its own port, keys and settings, and greets whoever logs in. Files of what is
# started by it go to the folder tmp. The client's settings are in ssh_config; whatever host they are used for is ADDRESS.
sshd_up() {
    local here=$PWD address=$1
    mkdir tmp
    ssh-keygen -q -t ed25519 -N '' -f host
    ssh-keygen -q -t ed25519 -N '' -f user
    cp user.pub authorized_keys
    printf 'Unauthorised use of this machine is not allowed.\n' > banner
    # ForceCommand prints to the stream that is the agent's afterwards, as start files of shells may do.
    cat > sshd_config <<CONF
ListenAddress $address
Port 2222
HostKey $here/host
PidFile $here/sshd.pid
AuthorizedKeysFile $here/authorized_keys
Banner $here/banner
ForceCommand echo "Welcome. Updates are available."; export TMPDIR=$here/tmp; eval "exec \$SSH_ORIGINAL_COMMAND"
StrictModes no
UsePAM no
PasswordAuthentication no
KbdInteractiveAuthentication no
PermitRootLogin prohibit-password
CONF
    # The folder into which the server locks those who are not yet logged in.
    mkdir -p /run/sshd
    /usr/sbin/sshd -f "$here/sshd_config" -E "$here/sshd.txt"
    printf '[%s]:2222 %s\n' "$address" "$(cat host.pub)" > known_hosts
    cat > ssh_config <<CONF
Host *
    HostName $address
    Port 2222
    IdentityFile $here/user
    IdentitiesOnly yes
    UserKnownHostsFile $here/known_hosts
    StrictHostKeyChecking yes
CONF
}
