//! Clips and rigs: an error or poses, in bounded time, the same whether stepping, seeking, reversing or streaming.

use pantin::{Bank, ChannelState, Clip, Player, Progress, Rig, SeekCache, SnapshotPos, Stream, Undo};

use pantin_convert::bank;

use crate::fix;
use crate::noise::Noise;

/// Values of poses that one input may make: less than a millisecond.
const VALUES: u64 = 16_000;
/// Steps back of one input.
const BACK: u32 = 40;
/// Seeks of one input.
const SEEKS: usize = 8;

/// For clips whose rig stands apart: one of our vectors' rig.
pub const RIG: &[u8] = include_bytes!("../../vectors/rig-apart.rig");

/// Opens a clip as it is and plays it.
pub fn open_play(bytes: &[u8]) -> bool {
    let Ok(clip) = Clip::with_rig(bytes, RIG) else { return false };
    play(clip, bytes);
    true
}

/// Mends the CRCs and lengths first, so that what lies behind them is reached.
pub fn crc_fixed_play(bytes: &[u8]) -> bool {
    let mut bytes = bytes.to_vec();
    fix::clip(&mut bytes);
    move_rig(&bytes);
    open_play(&bytes)
}

/// Makes the bytes a key clip whose CRCs are right, and plays it.
pub fn keys_play(bytes: &[u8]) -> bool {
    let mut bytes = bytes.to_vec();
    fix::key_clip(&mut bytes);
    move_rig(&bytes);
    open_play(&bytes)
}

/// Some of the vectors of key clips, and three that break a rule.
pub fn key_clips() -> Vec<Vec<u8>> {
    macro_rules! vectors {
        ($($name:literal),*) => { vec![$(include_bytes!(concat!("../../key-vectors/", $name, ".ptn")).to_vec()),*] };
    }
    vectors!(
        "walk",
        "run",
        "kinds",
        "loop",
        "odd-loop",
        "catmull-rom",
        "long-spans",
        "events",
        "face-yawn",
        "frames-2-loop",
        "malformed-acceleration",
        "malformed-noise",
        "malformed-few-states"
    )
}

/// Plays a key clip forwards, by seeking and backwards, in memory that is exactly as large as it says.
fn play_keys(clip: Clip<'_>, bytes: &[u8]) {
    let (channels, needed) = (clip.rig().channels(), clip.moving());
    let (mut states, mut pose) = (vec![ChannelState::default(); needed], vec![0; channels]);
    if needed > 0 {
        assert!(Player::new(clip, &mut states[1..], &mut pose).is_err());
    }
    let mut player = Player::new(clip, &mut states, &mut pose).expect("memory as asked for");
    let moving = player.states().len();
    assert!(moving <= channels && (!player.is_malformed() || moving == 0));
    for channel in 0..moving {
        let keys = player.channel_keys(channel).expect("a channel with keys");
        let last = clip.frames() - u32::from(!clip.looped());
        assert!(keys.iter().is_sorted_by(|(before, _), (after, _)| before < after), "keys out of order");
        assert_eq!(keys.iter().next().zip(keys.iter().last()).map(|(first, end)| (first.0, end.0)), Some((0, last)));
    }
    let frames = clip.frames().min(1 + (VALUES / channels.max(1) as u64) as u32) as usize;
    let mut stepped = Vec::with_capacity(frames * channels);
    for frame in 0..frames {
        assert_eq!(player.frame() as usize, frame);
        stepped.extend_from_slice(player.pose().values);
        player.step();
    }
    let mut noise = Noise::new(bytes.len() as u64);
    for _ in 0..SEEKS {
        let frame = noise.below(frames);
        player.seek(frame as u32);
        assert!(player.pose().values == &stepped[frame * channels..][..channels], "frame {frame} by seeking is another");
    }
    let mut memory = SeekCache::new(&player, &mut [], &mut [], &mut [], &mut []);
    for _ in 0..BACK.min(player.frame()) {
        player.step_back(&mut memory);
        let frame = player.frame() as usize;
        assert!(player.pose().values == &stepped[frame * channels..][..channels], "frame {frame} by going back is another");
    }
}

/// Takes the rig out of a clip or puts it in, as banks do: an error or a clip.
fn move_rig(bytes: &[u8]) {
    let Ok(clip) = Clip::with_rig(bytes, RIG) else { return };
    // Snapshots are made again, which takes a look at every frame.
    if clip.index_len() > 0 && u64::from(clip.frames()) * (1 + clip.moving() as u64) > VALUES {
        return;
    }
    let own = bank::rig_of(bytes).expect("a clip that opens");
    let whole = !own.is_empty();
    let own = if whole { own } else { RIG.to_vec() };
    let rig = bank::CheckedRig::new(&own).expect("a rig that opens");
    let moved = if whole { bank::without_rig(bytes, &rig) } else { bank::with_rig(bytes, &rig) };
    if let Ok(moved) = moved {
        let again = Clip::with_rig(&moved, &own).expect("a clip that was made");
        assert_eq!((again.frames(), again.moving()), (clip.frames(), clip.moving()));
        assert!(again.events().eq(clip.events()) && again.rig_len() > 0 || whole);
    }
}

/// Opens a rig, as it is and with its CRC mended, and walks it.
pub fn rig_open(bytes: &[u8]) -> bool {
    walk(bytes);
    let mut bytes = bytes.to_vec();
    fix::rig(&mut bytes);
    walk(&bytes)
}

fn walk(bytes: &[u8]) -> bool {
    let Ok(rig) = Rig::new_checked(bytes) else { return false };
    let mut channels = 0;
    for (index, joint) in rig.joints().enumerate() {
        assert!(joint.parent.map_or(index == 0, |parent| usize::from(parent) < index));
        assert_eq!(usize::from(joint.first_channel), channels);
        channels += joint.kinds.count();
    }
    assert_eq!((rig.joints().count(), channels), (rig.joint_count(), rig.joint_channels()));
    assert_eq!(rig.scalars().count() + channels, rig.channels());
    rig.scalars().for_each(|scalar| assert!(scalar.name().len() <= bytes.len().max(20)));
    assert_eq!(rig.id(), Rig::new_checked(bytes).map_or(0, |again| again.id()));
    true
}

/// Opens a bank, as it is and with its CRCs mended, and every clip in it.
pub fn bank_open(bytes: &[u8]) -> bool {
    bank_of(bytes);
    let mut bytes = bytes.to_vec();
    fix::bank(&mut bytes);
    bank_of(&bytes)
}

fn bank_of(bytes: &[u8]) -> bool {
    let Ok(bank) = Bank::new_checked(bytes) else { return false };
    assert!(bank.len() > 0 && bank.len() == bank.entries().count());
    for entry in bank.entries() {
        assert!(entry.bytes().len() <= bytes.len() && entry.name().len() <= bytes.len());
        assert!(entry.name().is_empty() || bank.find(entry.name()).is_some());
        if let Ok(clip) = bank.open(&entry) {
            assert_eq!((clip.rig().id(), clip.rig_len()), (bank.rig().id(), 0));
            play(clip, entry.bytes());
        }
    }
    true
}

fn play(clip: Clip<'_>, bytes: &[u8]) {
    if clip.has_keys() {
        return play_keys(clip, bytes);
    }
    let channels = clip.rig().channels();
    let moving = clip.moving();
    assert!(moving <= channels);
    let mut states = vec![ChannelState::default(); moving];
    let mut pose = vec![0; channels];
    if moving > 0 {
        assert!(Player::new(clip, &mut states[1..], &mut pose).is_err());
    }
    for joint in 0..clip.rig().joint_count() {
        clip.is_exponential(joint);
    }
    assert_eq!(clip.events().count(), clip.event_count());
    let frames = u64::from(clip.frames()).min(1 + VALUES / channels.max(1) as u64) as usize;
    let mut stepped = Vec::with_capacity(frames * channels);
    let mut player = Player::new(clip, &mut states, &mut pose).expect("memory as asked for");
    for frame in 0..frames {
        assert_eq!(player.frame() as usize, frame);
        stepped.extend_from_slice(player.pose().values);
        player.step();
    }
    // With its CRC mended, an index may say what it likes: nothing but the poses sought by it may suffer.
    let lies = clip.index_len() > 0;
    let mut noise = Noise::new(bytes.len() as u64);
    for _ in 0..SEEKS {
        let frame = noise.below(frames);
        player.seek(frame as u32);
        assert_eq!(player.frame() as usize, frame);
        assert!(lies || player.pose().values == &stepped[frame * channels..][..channels], "frame {frame} by seeking is another");
    }
    // Seeking far costs a look at every frame on the way.
    if u64::from(clip.frames()) * (1 + moving as u64) <= VALUES {
        player.seek(u32::MAX);
        assert_eq!(player.frame(), clip.frames() - 1);
    }
    player.rewind();
    assert!(player.pose().values == &stepped[..channels]);
    let mut lent =
        ([Undo::default(); 9], [SnapshotPos::default(); 3], vec![ChannelState::default(); 3 * moving], vec![0; 3 * moving]);
    let mut memory = SeekCache::new(&player, &mut lent.0, &mut lent.1, &mut lent.2, &mut lent.3);
    player.seek_with(noise.below(frames) as u32, &mut memory);
    for _ in 0..BACK.min(player.frame()) {
        player.step_back(&mut memory);
        let frame = player.frame() as usize;
        assert!(
            lies || player.pose().values == &stepped[frame * channels..][..channels],
            "frame {frame} by going back is another"
        );
    }
    stream(clip, bytes, &stepped);
}

/// Plays the bytes as they come, in pieces: the same poses. (An index may be damaged: a stream does not come to it.)
fn stream(clip: Clip<'_>, bytes: &[u8], stepped: &[i32]) {
    let channels = clip.rig().channels();
    let (mut states, mut pose) = (vec![ChannelState::default(); channels], vec![0; channels]);
    let mut buffer = [0; Stream::BUFFER];
    let mut stream = Stream::new(clip.rig(), &mut buffer, &mut states, &mut pose).expect("memory as asked for");
    let mut rest = bytes;
    let mut noise = Noise::new(bytes.len() as u64);
    loop {
        match stream.step() {
            Progress::NeedMore => {
                let taken = stream.feed(&rest[..(1 + noise.below(400)).min(rest.len())]);
                assert!(taken > 0, "a stream waits for more than there is");
                rest = &rest[taken..];
            }
            Progress::Frame => {
                let begin = stream.frame() as usize * channels;
                let Some(pose) = stepped.get(begin..begin + channels).filter(|_| begin < stepped.len()) else { return };
                assert!(stream.pose().values == pose, "frame {} by streaming is another", stream.frame());
            }
            Progress::End => return,
            Progress::Opened | Progress::Event(_) => {}
            Progress::Damaged(error) => panic!("a stream refuses what opened: {error:?}"),
            Progress::TooSmall => panic!("more channels move than there are"),
        }
    }
}
