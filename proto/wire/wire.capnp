# SPDX-License-Identifier: Apache-2.0
@0xb1f0c7d25a9e4e63;
# Every message between corridor's processes. This file is the reference: who sends what, what
# answers it, in which order, in which unit, up to which size. proto/wire/messages.h holds the same
# as plain values, proto/wire/codec.h turns one into the other, proto/wire/endpoint.h carries them.
#
# A message is two ZeroMQ frames: a Header, and a body (Request or Reply; empty for some kinds).
#
#   actor   --ReplayRequest--> replay     join, insert
#   learner --ReplayRequest--> replay     join, openBlock, step, save
#   actor   --LearnerRequest-> learner    weights, selection
#
# Every request is answered by exactly one reply. A client numbers its requests 1, 2, 3 ... and
# sends one again when it is unanswered for a while; the server carries out each number once, in
# order, and answers a repeated one from its memory. A server that cannot answer yet (it waits for
# others) answers each repetition with `pending`, so that a waiting client knows it alive.
#
# Limits are in proto/settings/limits.h: of a Data field kDataBytesMax, unless another one is named
# beside it; of observations kObservationsMax.

using Cxx = import "/capnp/c++.capnp";
$Cxx.namespace("corridor::wire");

struct Header {
  protocol @0 :UInt32;     # kProtocolVersion of proto/wire/messages.h; a server refuses any other
  runId @1 :Text;          # 32 hex digits, drawn at `corridor train`; a server refuses any other
                           # (and drops more than kRunIdBytesMax bytes)
  role @2 :Role;           # of the client
  index @3 :UInt32;        # of the client among its role: 0 .. actors-1; 0 for the learner
  incarnation @4 :UInt64;  # grows with every start of the client (proto/system/identity.h): a
                           # lesser one is refused, also when it has never been seen
  sequence @5 :UInt64;     # of the request, from 1; a reply carries its request's
  kind @6 :Kind;
  refusal @7 :Text;        # of `refused`: one line for people, at most kRefusalBytesMax bytes

  enum Role { actor @0; learner @1; }
  enum Kind {
    request @0;
    reply @1;
    pending @2;   # the request stands; keep waiting
    refused @3;   # the client must end: another protocol, run, incarnation, or a request that is
                  # impossible for this server (the text says which)
  }
}

struct OpenEpisode {
  # The episode that an actor is in at the end of a round. (seed, actions) drives it again bit for
  # bit, so this is an actor's whole state.
  episode @0 :UInt64;   # counts the actor's episodes in this phase, from 0
  actions @1 :Data;     # one byte a step driven so far (actor/driving/action.h);
                        # at most kActionsBytesMax bytes
}

struct ReplayRequest {
  union {
    join @0 :Void;
    # First message of every client. Answer: joined.

    insert :group {
      # actor: all transitions that became complete in one round. Admitted in the order
      # (round, actor) once the learner has opened block `round`; until
      # then it is parked (a round or two ahead at most). Answer: inserted, at once.
      round @1 :UInt64;
      observations @2 :UInt32;  # of the row layout (proto/settings/transition.h)
      rows @3 :Data;            # float32, little-endian, whole rows
      priorities @4 :Data;      # float32, one a row: |TD error| by the actor's weights; finite,
                                # >= 0
      open @5 :OpenEpisode;
    }

    openBlock :group {
      # learner: block `round` begins; all chunks of rounds <= round are to be admitted, none
      # later. Answer: opened, when every actor's chunk of the round is there.
      round @6 :UInt64;
    }

    step :group {
      # learner: apply the new priorities of an earlier answer, then draw anew, more often than
      # there are rows if so many are wanted.
      # Only in an open block. Answer: batch.
      keys @7 :Data;            # uint64, as they came in an earlier batch; may be empty
      priorities @8 :Data;      # float32 |TD error|, one a key; finite, >= 0
      count @9 :UInt32;         # rows to draw, at most kRowsPerStepMax; 0: none
      importanceExponent @10 :Float64;  # beta, in [0, 1]
    }

    save :group {
      # learner, between blocks: write everything that belongs to rounds <= the last block's into
      # the directory, beside the serving (proto/run/checkpoints.h). To be repeated, between later
      # blocks, until the answer says that it is complete. Answer: saved, at once.
      directory @11 :Text;      # at most kDirectoryBytesMax bytes
      previous @12 :Text;       # the newest checkpoint, to link to what it has already; or empty
    }
  }
}

struct ReplayReply {
  union {
    joined :group {
      nextRound @0 :UInt64;     # the first round of which nothing is there yet, for this actor
      open @1 :OpenEpisode;     # as of the round before; episode 0 without actions at the start
    }
    inserted @2 :Void;
    opened :group {
      batches @3 :UInt32;       # that the samples-per-insert limiter grants to this block
    }
    batch :group {
      observations @4 :UInt32;
      rows @5 :Data;            # float32, `count` rows, or none
      keys @6 :Data;            # uint64: insert index, never reused
      weights @7 :Data;         # float32 importance weights, largest of the batch = 1
    }
    saved :group {
      complete @8 :Bool;        # all of it is on disk
    }
  }
}

struct LearnerRequest {
  union {
    weights :group {
      # actor: wants this version, neither older nor newer. Answer: weights, when published.
      version @0 :UInt64;
    }
    selection :group {
      # actor: outcome of the greedy evaluation that it drove before round `round`, its share of
      # the episodes. Answer: noted.
      round @1 :UInt64;
      episodes @2 :UInt32;
      steps @3 :UInt64;
      reward @4 :Float64;      # of the phase's planner, summed, unscaled, without shaping
      collisions @5 :UInt64;
    }
  }
}

struct NamedParameters {
  name @0 :Text;           # at most kNetworkNameBytesMax bytes
  parameters @1 :Data;     # float32 (RunConfig::parameters)
}

struct LearnerReply {
  union {
    weights :group {
      version @0 :UInt64;
      networks @1 :List(NamedParameters);  # all of kNetworks (proto/settings/named_networks.h), in
                                           # its order; before its phase an untrained one
    }
    noted @2 :Void;
  }
}
