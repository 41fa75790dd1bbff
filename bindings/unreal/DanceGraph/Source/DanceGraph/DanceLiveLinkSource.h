// DanceLiveLinkSource: the dancers of a house as Live Link subjects of the animation role, one for
// each guest, with the 22 canonical bones. A Live Link Retarget Asset maps their names to a rig's.
//
// Units/frames: Unreal's: centimetres, left-handed, +Z up, a dancer in T-pose faces +X. Transforms
//               are local: of each bone in its parent, of the hips on the stage.
// Ownership:    its thread and its handle; the Live Link client outlives it.
// Threads:      made and ended in the game thread; a thread of its own reads and pushes frames.
// Failure:      without library (in the plug-in's folder, else the system's) or house there are no
//               subjects; the status in the Live Link window says why.
#pragma once

#include <CoreMinimal.h>
#include <HAL/Runnable.h>
#include <HAL/RunnableThread.h>
#include <HAL/ThreadSafeBool.h>
#include <ILiveLinkSource.h>

#include <DanceAdapter.hpp>

class FDanceLiveLinkSource : public ILiveLinkSource, public FRunnable {
 public:
  explicit FDanceLiveLinkSource(const FString& HouseName);
  virtual ~FDanceLiveLinkSource() override;

  // ILiveLinkSource
  virtual void ReceiveClient(ILiveLinkClient* InClient, FGuid InSourceGuid) override;
  virtual bool IsSourceStillValid() const override;
  virtual bool RequestSourceShutdown() override;
  virtual FText GetSourceType() const override;
  virtual FText GetSourceMachineName() const override;
  virtual FText GetSourceStatus() const override;

  // FRunnable
  virtual uint32 Run() override;
  virtual void Stop() override;

 private:
  // A subject that Live Link knows: the skeleton it has been given, and its newest pose.
  struct FDancer {
    FName Subject;
    char Id[sizeof(dance_guest::id)] = "";
    uint32 Generation = 0;
    dance_skeleton Skeleton{};
    uint32 Sequence = 0;
    bool bIsKnown = false;
    bool bIsHere = false;
  };

  void PushDancers();
  bool PushSkeleton(FDancer& Dancer, const dance_guest& Guest);
  void PushPose(FDancer& Dancer, const dance_guest& Guest);
  void RemoveSubject(FDancer& Dancer);

  FString HouseName;
  dancegraph::Library Library;
  dancegraph::Adapter Adapter;
  dancegraph::GuestList Guests;
  dance_pose Pose;
  FDancer Dancers[DANCE_MAX_GUESTS];  // by slot
  ILiveLinkClient* Client = nullptr;
  FGuid SourceGuid;
  FRunnableThread* Thread = nullptr;
  FThreadSafeBool bIsStopping;
};
